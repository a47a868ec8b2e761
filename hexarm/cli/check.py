"""`hexarm check FILE`: everything that is wrong with a machine file, at once."""

import argparse
import json
from typing import Any

import numpy as np

from hexarm.cli.statuses import REFUSED
from hexarm.machine_check import Report, report_of
from hexarm.machines import find, text_of
from manipulator.config import parse_yaml
from manipulator.errors import ConfigError
from manipulator.formatting import counted
from manipulator.machine import Machine


def add_parser(commands: 'argparse._SubParsersAction[argparse.ArgumentParser]') -> None:
    """Declares the subcommand."""
    parser = commands.add_parser('check', help='print all problems of a machine file')
    parser.add_argument('file', metavar='FILE', help='the path of a file, or a shipped name')
    parser.add_argument('--json', action='store_true', help='answer for programs')
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    """Prints problems and warnings, one a line, and home's joints; status 2 for problems."""
    try:
        path = find(arguments.file)
        report = report_of(parse_yaml(text_of(path), str(path)))
        lines = _in_words(arguments.file, report)
    except ConfigError as error:
        report = Report(error.problems)
        lines = [str(error)]
    print(
        json.dumps(_for_programs(report), ensure_ascii=False)
        if arguments.json
        else '\n'.join(lines)
    )
    return REFUSED if report.problems else 0


def _in_words(file: str, report: Report) -> list[str]:
    problems, warnings = len(report.problems), len(report.warnings)
    summary = counted(problems, 'problem') if problems else 'no problems'
    if warnings:
        summary += f', {counted(warnings, "warning")}'
    lines = [f'{file}: {summary}', *report.problems, *(f'warning: {w}' for w in report.warnings)]
    return lines if report.machine is None else [*lines, _home_in_words(report.machine)]


def _home_in_words(machine: Machine) -> str:
    kinematics = machine.kinematics
    joints = kinematics.inverse(kinematics.home)
    factor, unit = (np.degrees(1.0), '°') if kinematics.joint_unit == 'rad' else (1e3, ' mm')
    values = '  '.join(f'{value:.1f}' for value in factor * joints)
    return f'joints at home: {values}{unit}'


def _for_programs(report: Report) -> dict[str, Any]:
    """Joints in radians or metres."""
    found: dict[str, Any] = {
        'problems': list(report.problems),
        'warnings': list(report.warnings),
    }
    if report.machine is not None:
        kinematics = report.machine.kinematics
        positions = kinematics.inverse(kinematics.home).tolist()
        names = list(kinematics.joint_names)
        found['joints_at_home'] = {'names': names, 'positions': positions}
    return found
