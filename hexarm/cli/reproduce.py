"""`hexarm reproduce`: everything that the three papers report, computed again, as a report."""

import argparse
from collections.abc import Iterator
from pathlib import Path

from hexarm.cli.progress import OnProgress, progress
from hexarm.papers.finding import Finding, rendered, to_json
from manipulator.errors import InvalidInput
from manipulator.formatting import reason

POINTS, DRAWS = 400_000, 4000
FEW_POINTS, FEW_DRAWS = 20_000, 400


def add_parser(commands: 'argparse._SubParsersAction[argparse.ArgumentParser]') -> None:
    """Declares the subcommand."""
    parser = commands.add_parser(
        'reproduce', help='the figures of the three papers, in some minutes'
    )
    parser.add_argument(
        '--output', type=Path, default=Path('docs/reproduction.md'), metavar='FILE.md',
        help='the report; its figures and numbers go beside it (default docs/reproduction.md)',
    )  # fmt: skip
    parser.add_argument('--quick', action='store_true', help='fewer samples, within seconds')
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    """Writes the report, its figures and its numbers; prints contradictions."""
    from hexarm.papers import crank_dynamics, pictures  # noqa: PLC0415 (needs mujoco)

    output: Path = arguments.output
    if output.suffix != '.md':
        raise InvalidInput(f'--output {output}: the name must end in .md')
    folder = output.parent / 'figures'
    with progress() as on_progress:
        dynamics = crank_dynamics.reproduced()
        on_progress('simulation and limits', 1.0)
        found = [*computed(arguments.quick, on_progress, dynamics.findings)]
        figures = [(f'figures/{name}', caption) for name, caption in pictures.NAMES.items()]
        try:
            folder.mkdir(parents=True, exist_ok=True)
            pictures.draw(folder, dynamics.recording)
            output.write_text(rendered(found, figures), encoding='utf-8')
            output.with_suffix('.json').write_text(to_json(found), encoding='utf-8')
        except OSError as error:
            raise InvalidInput(f'cannot write {output}: {reason(error)}') from error
        on_progress('report', 1.0)
    for finding in found:
        if finding.verdict == 'contradicts':
            print(f'{finding.source}, {finding.topic}: {finding.paper}; ours {finding.ours}')
    print(output)
    return 0


def computed(quick: bool, on_progress: OnProgress, simulated: list[Finding]) -> Iterator[Finding]:
    """All findings in the report's order; those of the simulation are made before."""
    from hexarm.papers import arm_modes, crank_kinematics, linear_platforms  # noqa: PLC0415

    draws, points = (FEW_DRAWS, FEW_POINTS) if quick else (DRAWS, POINTS)
    yield from crank_kinematics.findings(draws, points, not quick, on_progress)
    yield from simulated
    yield from linear_platforms.findings()
    on_progress('linear platforms', 1.0)
    yield from arm_modes.findings()
    on_progress('arm', 1.0)
