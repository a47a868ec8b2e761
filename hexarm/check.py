"""`hexarm check FILE`: everything that is wrong with a machine file, at once."""

import argparse
import json

from hexarm.machine_check import problems_of
from hexarm.machines import find, text_of
from hexarm.statuses import REFUSED
from manipulator.errors import ConfigError
from manipulator.words import counted


def add_parser(commands: 'argparse._SubParsersAction[argparse.ArgumentParser]') -> None:
    """Declares the subcommand."""
    parser = commands.add_parser('check', help='say everything that is wrong with a machine file')
    parser.add_argument('file', metavar='FILE', help='the path of a file, or a shipped name')
    parser.add_argument('--json', action='store_true', help='answer for programs')
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    """Prints the problems, one a line; status 2 when there are any."""
    try:
        problems = problems_of(text_of(find(arguments.file)))
    except ConfigError as error:
        problems = list(error.problems)
    if arguments.json:
        print(json.dumps({'problems': problems}, ensure_ascii=False))
    else:
        count = counted(len(problems), 'problem') if problems else 'no problems'
        print('\n'.join([f'{arguments.file}: {count}', *problems]))
    return REFUSED if problems else 0
