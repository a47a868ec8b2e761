"""`hexarm machines`: the machine files that come with the package."""

import argparse

from hexarm.cli.answers import Answer, answering
from hexarm.machines import read, shipped


def add_parser(commands: 'argparse._SubParsersAction[argparse.ArgumentParser]') -> None:
    """Declares the subcommand."""
    parser = commands.add_parser('machines', help='list the machine files that are shipped')
    parser.add_argument('--json', action='store_true', help='answer for programs')
    parser.set_defaults(run=answering(answer))


def answer(arguments: argparse.Namespace) -> Answer:
    """Name, kind, description and path of each."""
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
    return {'machines': entries}, lines
