"""`hexarm reproduce`: everything that the three papers report, computed again, as a report."""

import argparse
from pathlib import Path

from hexarm.cli.answers import Answer, answering
from hexarm.cli.progress import progress
from hexarm.papers.finding import Missing
from hexarm.papers.report import rendered, to_json
from hexarm.papers.reproduction import Reproduction, contradictions, reproduced
from manipulator.errors import InvalidInput
from manipulator.formatting import reason

OUTPUT = Path('reproduction', 'reproduction.md')


def add_parser(commands: 'argparse._SubParsersAction[argparse.ArgumentParser]') -> None:
    """Declares the subcommand."""
    parser = commands.add_parser('reproduce')
    parser.add_argument(
        '--output', type=Path, default=OUTPUT, metavar='FILE.md',
        help=f'the report; its figures and numbers go beside it (default {OUTPUT})',
    )  # fmt: skip
    parser.add_argument(
        '--quick', action='store_true',
        help='fewer samples, no noise in the moving model: some seconds',
    )  # fmt: skip
    parser.add_argument('--json', action='store_true', help='answer for programs')
    parser.set_defaults(run=answering(answer))


def answer(arguments: argparse.Namespace) -> Answer:
    """Writes the report and what belongs to it; what contradicts the papers or is missing."""
    output: Path = arguments.output
    if output.suffix != '.md':
        raise InvalidInput(f'--output {output}: the name must end in .md')
    with progress() as on_stage:
        this = reproduced(arguments.quick, on_stage)
        try:
            write(this, output)
        except OSError as error:
            raise InvalidInput(f'cannot write {output}: {reason(error)}') from error
        on_stage('report', 1.0)
    contradicted = list(contradictions(this.findings))
    lacking = [f'{part.source}, {part.topic}: {part.why}' for part in this.missing]
    files = {'report': str(output), 'numbers': str(output.with_suffix('.json'))}
    lines = [*contradicted, *(f'missing: {text}' for text in lacking), str(output)]
    return {**files, 'contradictions': contradicted, 'missing': lacking}, lines


def write(this: Reproduction, output: Path) -> None:
    """The report and the same as JSON, with the figures in a folder beside them."""
    folder = output.parent / 'figures'
    folder.mkdir(parents=True, exist_ok=True)
    captions = _drawn(this, folder)
    figures = [(f'figures/{name}', caption) for name, caption in captions.items()]
    output.write_text(rendered(this.report, figures), encoding='utf-8')
    output.with_suffix('.json').write_text(to_json(this.report), encoding='utf-8')


def _drawn(this: Reproduction, folder: Path) -> dict[str, str]:
    """The figures by name, with their captions; what cannot be drawn goes to the missing."""
    try:
        from hexarm.papers import pictures  # noqa: PLC0415 (matplotlib is an extra)
    except ModuleNotFoundError as error:
        this.missing.append(Missing('figures', 'all', f'{error.name} is not installed'))
        return {}
    names = []
    for item in pictures.draw(folder, this.recording):
        if isinstance(item, Missing):
            this.missing.append(item)
        else:
            names.append(item)
    return {name: pictures.NAMES[name] for name in names}
