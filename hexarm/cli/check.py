"""`hexarm check FILE`: everything wrong with a machine file; `hexarm machines`: a list."""

import argparse
import json
from typing import Any

from hexarm.cli.answers import Answer, Units, add_units, answering, units_of
from hexarm.cli.statuses import REFUSED
from hexarm.machine_check import Report, report_of
from hexarm.machines import find, read, shipped, text_of
from manipulator.analysis.inside import AXES, ranges
from manipulator.analysis.reach import smallest_margins
from manipulator.analysis.readings import LimitReading
from manipulator.config import parse_yaml
from manipulator.errors import ConfigError
from manipulator.formatting import counted
from manipulator.machine import Machine


def add_parser(commands: 'argparse._SubParsersAction[argparse.ArgumentParser]') -> None:
    """Declares both subcommands."""
    parser = commands.add_parser('check')
    parser.add_argument('file', metavar='FILE', help='the path of a file, or a shipped name')
    parser.add_argument('--json', action='store_true', help='answer for programs')
    add_units(parser)
    parser.set_defaults(run=run)
    parser = commands.add_parser('machines')
    parser.add_argument('--json', action='store_true', help='answer for programs')
    parser.set_defaults(run=answering(shipped_machines))


def shipped_machines(arguments: argparse.Namespace) -> Answer:
    """Name, kind, description and path of each machine file that comes with the package."""
    entries = []
    for name, path in shipped().items():
        machine = read(name)
        entries.append(
            {
                'name': name,
                'kind': machine.kind,
                'description': machine.description,
                'path': str(path),
            }
        )
    lines = [f'{e["name"]:<14} {e["kind"]:<18} {e["description"]}' for e in entries]
    return {'machines': entries}, [*lines, f'in {path.parent}']


def run(arguments: argparse.Namespace) -> int:
    """Prints problems and warnings, one a line, and what home is like; status 2 for problems."""
    try:
        path = find(arguments.file)
        report = report_of(parse_yaml(text_of(path), str(path)), path.parent)
        lines = _in_words(arguments.file, report, units_of(arguments))
    except ConfigError as error:
        report = Report(error.problems)
        lines = [str(error)]
    print(
        json.dumps(_for_programs(report), ensure_ascii=False)
        if arguments.json
        else '\n'.join(lines)
    )
    return REFUSED if report.problems else 0


def _in_words(file: str, report: Report, units: Units) -> list[str]:
    problems, warnings = len(report.problems), len(report.warnings)
    summary = counted(problems, 'problem') if problems else 'no problems'
    if warnings:
        summary += f', {counted(warnings, "warning")}'
    lines = [f'{file}: {summary}', *report.problems, *(f'warning: {w}' for w in report.warnings)]
    return lines if report.machine is None else [*lines, *_home_in_words(report.machine, units)]


def _home_in_words(machine: Machine, units: Units) -> list[str]:
    """Joints there, how far it is from there along and about each axis, the nearest limits."""
    kinematics = machine.kinematics
    joints = kinematics.inverse(kinematics.home)
    lines = [f'joints at home: {units.quantities(joints, kinematics.joint_unit)}']
    margins, reach = smallest_margins(machine), _reach(machine)
    for unit, axes in {'m': AXES[:3], 'rad': AXES[3:]}.items() if reach else ():
        ends = (f'{a} {" … ".join(units.number(end, unit) for end in reach[a])}' for a in axes)
        lines.append(f'reach from home: {"  ".join(ends)} {units.name(unit)}')
    if margins:
        lines.append(f'smallest margins at home: {", ".join(_margin(r, units) for r in margins)}')
    return lines


def _reach(machine: Machine) -> dict[str, tuple[float, float]]:
    """See `ranges`; empty where home itself is beyond a limit."""
    home = machine.kinematics.home
    is_good = bool(machine.constraints.admits(home, machine.kinematics.inverse(home)))
    return ranges(machine) if is_good else {}


def _margin(reading: LimitReading, units: Units) -> str:
    owner = f' ({reading.owner})' if reading.owner else ''
    unit = f' {units.name(reading.unit)}'.rstrip().replace(' °', '°')
    return f'{reading.quantity} {reading.margin * units.factor(reading.unit):.4g}{unit}{owner}'


def _for_programs(report: Report) -> dict[str, Any]:
    """Joints in radians or metres, as all that follows."""
    found: dict[str, Any] = {
        'problems': list(report.problems),
        'warnings': list(report.warnings),
    }
    if report.machine is not None:
        machine, kinematics = report.machine, report.machine.kinematics
        positions = kinematics.inverse(kinematics.home).tolist()
        names = list(kinematics.joint_names)
        found['joints_at_home'] = {'names': names, 'positions': positions}
        found['reach'] = {axis: list(ends) for axis, ends in _reach(machine).items()}
        found['smallest_margins'] = [
            {'quantity': r.quantity, 'owner': r.owner, 'unit': r.unit, 'margin': r.margin}
            for r in smallest_margins(machine)
        ]
    return found
