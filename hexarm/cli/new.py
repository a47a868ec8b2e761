"""`hexarm new FILE`: a machine file of the measures that people have, asked for or given."""

import argparse
import json
import os
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

from arm_control.urdf_chain import arm_of
from arm_control.urdf_file import read_urdf
from hexarm import arm_import
from hexarm.cli import check
from hexarm.cli.answers import refuse
from hexarm.cli.import_arm import urdf_text
from hexarm.cli.statuses import INTERRUPTED
from hexarm.machine_check import report_of
from hexarm.machines import load, text_of
from hexarm.new.arms import arm_text
from hexarm.new.cranks import crank_text
from hexarm.new.cylinders import cylinder_text
from hexarm.new.questions import QUESTIONS, Question, checked
from hexarm.new.rails import rail_text
from manipulator.config import parse_yaml
from manipulator.errors import ConfigError, InvalidInput, ManipulatorError
from manipulator.formatting import reason, shown
from manipulator.requirements import missing

Ask = Callable[[str], str]
WORKSPACE_POINTS = {True: 20_000, False: 1000}
"""By whether the inverse is explicit: a picture within some seconds."""
TEXTS = {'crank': crank_text, 'linear': cylinder_text, 'rail': rail_text, 'arm': arm_text}
WELCOME = """\
hexarm new makes a machine file of your measures: millimetres, degrees, grams.
Enter takes what is in [brackets]; an answer that is not understood is asked for again.
Ctrl-C ends, and nothing is written.
"""


def add_parser(commands: 'argparse._SubParsersAction[argparse.ArgumentParser]') -> None:
    """Declares the subcommand."""
    parser = commands.add_parser('new', epilog=f'measures:\n{_listed()}')
    parser.add_argument(
        'file', nargs='?', type=Path, default=Path('my_machine.yaml'), metavar='FILE',
        help='what to write; default: my_machine.yaml',
    )  # fmt: skip
    parser.add_argument(
        '--answers', type=Path, metavar='FILE', help='the measures, as YAML: nothing is asked'
    )
    parser.add_argument(
        '--set', nargs='+', default=[], metavar='KEY=VALUE', help='measures, likewise'
    )
    parser.add_argument(
        '--no-pictures', action='store_true', help='do not draw machine and workspace'
    )
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    """Asks, writes, draws, checks; 130 after Ctrl-C, with either a whole file or none."""
    path: Path = arguments.file
    try:
        _check_free(path)
        text = _text(arguments)
        _write(path, text)
    except ManipulatorError as error:
        return refuse(str(error), is_for_programs=False)
    except EOFError:
        return refuse('the input ended before the last question; nothing is written', False)
    except KeyboardInterrupt:
        print('\nnothing is written')
        return INTERRUPTED
    print(f'{path}: written')
    status = check.run(argparse.Namespace(file=str(path.absolute()), json=False, units='mm'))
    try:
        pictures = [] if arguments.no_pictures else _pictures(path)
    except KeyboardInterrupt:
        print(f'\n{path} is whole, its pictures are not drawn')
        return INTERRUPTED
    print('\n'.join([*pictures, '', *_next_steps(path)]))
    return status


def _check_free(path: Path) -> None:
    if path.suffix not in ('.yaml', '.yml'):
        raise InvalidInput(f'{path}: the name of a machine file ends in .yaml')
    if os.path.lexists(path):
        raise InvalidInput(f'{path} exists: give another name, nothing is written over')
    if not path.absolute().parent.is_dir():
        raise InvalidInput(f'{path}: there is no folder {path.absolute().parent}')


def _text(arguments: argparse.Namespace) -> str:
    """The machine file, by the answers given or asked for."""
    if arguments.answers is None and not arguments.set:
        return asked(input, print, _described(arguments.file))
    given: dict[str, Any] = {'description': _described(arguments.file)}
    if arguments.answers is not None:
        given |= parse_yaml(text_of(arguments.answers), str(arguments.answers))
    for word in arguments.set:
        key, equals, value = word.partition('=')
        if not equals:
            raise InvalidInput(f'--set {shown(word)}: needs KEY=VALUE')
        given[key.strip()] = value
    return machine_text(checked(given))


def _described(path: Path) -> str:
    return path.stem.replace('_', ' ')


def machine_text(measures: Mapping[str, Any]) -> str:
    """The text of the machine file; InvalidInput or ConfigError for what no machine has."""
    if measures.get('given_by') == 'urdf':
        return _of_urdf(Path(measures['urdf']).expanduser(), measures['tip'])
    lines = [*TEXTS[measures['kind']](measures), '', '# Measures given to hexarm new:']
    for key in dict.fromkeys(q.key for q in QUESTIONS if q.key in measures):
        lines.append(f'#   {key}: {json.dumps(measures[key], ensure_ascii=False)}')
    text = '\n'.join(line.rstrip() for line in lines) + '\n'
    report = report_of(parse_yaml(text))
    if report.problems:
        raise ConfigError(report.problems)
    return text


def _of_urdf(source: Path, tip: str) -> str:
    try:
        robot = read_urdf(urdf_text(source))
        arm = arm_of(robot, None, None if tip == 'auto' else tip)
        name = robot.name or source.stem
        return arm_import.machine_text(arm, name, source.name, arm_import.ImportOptions()).text
    except ConfigError as error:
        raise ConfigError(error.problems, str(source)) from error


def asked(ask: Ask, tell: Callable[[str], None], description: str) -> str:
    """The machine file, by questions; those that do not fit each other can be asked again."""
    tell(WELCOME)
    answers: dict[str, Any] = {}
    _fill(answers, ask, tell, description)
    while True:
        try:
            return machine_text(answers)
        except ManipulatorError as error:
            tell(f'These measures do not fit each other:\n{error}')
        _forget(answers, ask, tell)
        _fill(answers, ask, tell, description)


def _fill(
    answers: dict[str, Any], ask: Ask, tell: Callable[[str], None], description: str
) -> None:
    """Asks whatever there is no answer to yet."""
    for question in QUESTIONS:
        if question.key not in answers and question.is_asked(answers):
            usual = description if question.key == 'description' else question.default
            answers[question.key] = _answer(question, usual, ask, tell)


def _forget(answers: dict[str, Any], ask: Ask, tell: Callable[[str], None]) -> None:
    """Drops one answer, and those that were asked because of it."""
    while True:
        key = ask(f'Change which one? ({", ".join(answers)}): ').strip()
        if key in answers:
            break
        tell(f'  {shown(key)} is not one of these')
    del answers[key]
    for question in QUESTIONS:
        if question.key in answers and not any(
            other.is_asked(answers) for other in QUESTIONS if other.key == question.key
        ):
            del answers[question.key]


def _answer(question: Question, usual: Any, ask: Ask, tell: Callable[[str], None]) -> Any:
    """One answer, asked for until it is understood."""
    if question.choices:
        tell(f'\n{question.text}')
        for k, (word, meaning) in enumerate(question.choices.items(), start=1):
            tell(f'  {k}  {word:<12} {meaning}')
    if question.parse_row is not None:
        tell(f'\n{question.key}: {question.text}')
        return [_understood(f'  {name}: ', question.parse_row, None, ask, tell)
                for name in question.rows]  # fmt: skip
    shown_usual = '' if usual is None else f' [{_typed(usual)}]'
    prompt = question.key if question.choices else f'{question.key}: {question.text}'
    return _understood(f'{prompt}{shown_usual}: ', question.parse, usual, ask, tell)


def _understood(
    prompt: str, parse: Callable[[Any], Any], usual: Any, ask: Ask, tell: Callable[[str], None]
) -> Any:
    while True:
        typed = ask(prompt).strip()
        if not typed and usual is None:
            tell('  an answer is needed')
            continue
        try:
            return parse(typed or usual)
        except InvalidInput as error:
            tell(f'  {error}')


def _typed(value: Any) -> str:
    return ' '.join(f'{v:g}' for v in value) if isinstance(value, list) else (
        f'{value:g}' if isinstance(value, float) else str(value))  # fmt: skip


def _write(path: Path, text: str) -> None:
    """All of it or nothing, and nothing over another file."""
    try:
        file = path.open('x', encoding='utf-8')
    except FileExistsError:
        raise InvalidInput(f'{path} exists: nothing is written over') from None
    except OSError as error:
        raise InvalidInput(f'cannot write {path}: {reason(error)}') from error
    try:
        with file:
            file.write(text)
    except BaseException as error:
        path.unlink(missing_ok=True)
        if isinstance(error, OSError):
            raise InvalidInput(f'cannot write {path}: {reason(error)}') from error
        raise


def _pictures(path: Path) -> list[str]:
    """The machine at home, and its workspace; lines that say where, or why not."""
    machine = load(str(path.absolute()))
    files = [path.with_suffix('.png'), path.with_name(f'{path.stem}_workspace.png')]
    taken = next((file for file in files if os.path.lexists(file)), None)
    if taken is not None:
        return [f'not drawn: {taken} exists']
    try:
        from hexarm.pictures import machine as machine_picture  # noqa: PLC0415 (an extra)
        from hexarm.pictures import workspace  # noqa: PLC0415

        machine_picture.draw(machine, machine.kinematics.home, files[0], path.stem)
        points = WORKSPACE_POINTS[machine.kinematics.is_explicit]
        workspace.draw_quickly(machine, files[1], path.stem, points)
        return list(map(str, files))
    except ModuleNotFoundError as error:
        return [f'not drawn: {missing(error)}']
    except ManipulatorError as error:
        return [f'not drawn: {error}']


def _next_steps(path: Path) -> Iterator[str]:
    name = path if '/' in str(path) else f'./{path}'
    yield 'next:'
    yield '  look at the pictures: are the joints where yours are?'
    yield f'  hexarm up {name} --panel   drive it in a browser, on a fake board'
    if 'servos:' in path.read_text(encoding='utf-8'):
        yield f'  hexarm calibrate servos {name} --port /dev/ttyACM0   (docs/wiring.md)'
    else:
        yield '  docs/your-arm.md: what the driver of the joints publishes and receives'


def _listed() -> str:
    """All measures, for --help."""
    rows: list[tuple[str, str]] = []
    for question in QUESTIONS:
        if question.key not in {key for key, _ in rows}:
            usual = question.default
            text = question.text if usual in (None, '') else f'{question.text} [{_typed(usual)}]'
            some = f': {", ".join(question.choices)}' if question.choices else ''
            rows.append((question.key, f'{text}{some}'))
    return '\n'.join(f'  {key:<24} {text}' for key, text in rows)
