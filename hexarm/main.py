"""The `hexarm` command: picks the subcommand and turns errors into one line and a status."""

import argparse
import sys

from hexarm import demo, firmware_header, fk, ik, machine_list, up
from manipulator.errors import ManipulatorError

COMMANDS = (up, demo, ik, fk, machine_list, firmware_header)


def main(words: list[str] | None = None) -> int:
    """Runs one subcommand; status 1 when something failed, 2 for a refusal or bad arguments."""
    parser = argparse.ArgumentParser(
        prog='hexarm', description='Six-axis manipulators, from a pose target to servo pulses.'
    )
    commands = parser.add_subparsers(required=True, metavar='COMMAND')
    for command in COMMANDS:
        command.add_parser(commands)
    arguments = parser.parse_args(words)
    try:
        return int(arguments.run(arguments))
    except ManipulatorError as error:
        print(f'hexarm: {error}', file=sys.stderr)
        return 1


if __name__ == '__main__':
    sys.exit(main())
