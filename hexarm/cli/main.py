"""The `hexarm` command: picks the subcommand and turns errors into one line and a status."""

import argparse
import contextlib
import os
import re
import sys
from pathlib import Path
from typing import Any, NoReturn

from hexarm.cli.commands import Commands, declare
from hexarm.cli.statuses import INTERRUPTED, PIPE_CLOSED, REFUSED
from manipulator.errors import ConfigError, InvalidInput, ManipulatorError, Refused
from manipulator.formatting import did_you_mean, nearest, shown
from manipulator.requirements import missing

EXAMPLES = """\
examples:
  hexarm demo                                          the whole graph on a fake board
  hexarm up hexapod                                    the graph, until Ctrl-C
  hexarm up hexapod --port /dev/ttyACM0                the same with a real board
  hexarm go hexapod --xyz 0 0 0.047 --rpy 0 0 0.1      move it, from another terminal
  hexarm ik robocake --xyz 0 0 0.045 --rpy 0 0 0.1     metres and radians
  hexarm check my_machine.yaml                         what is wrong with a machine file
  hexarm calibrate servos robocake --output mine.yaml  signs and centres, on a fake board

MACHINE is a shipped name (hexarm machines) or the path of a YAML file; NAMESPACE is where a
machine runs. `hexarm COMMAND --help` describes a command; docs/cli.md has the exit statuses.
"""


MOST_OF_AN_ERROR = 400
"""Characters of a wrong argument's message, which has room for the names of all commands."""


class Parser(argparse.ArgumentParser):
    """Names the nearest command, choice or option for one that does not exist."""

    def parse_known_args(self, args: Any = None, namespace: Any = None) -> Any:
        """As argparse's, but each subcommand reports what it does not know, with its own usage."""
        arguments, unknown = super().parse_known_args(args, namespace)
        if unknown:
            near = nearest(unknown[0].partition('=')[0], self._option_string_actions)
            meant = did_you_mean(near if unknown[0].startswith('--') else '')
            super().error(f'{shown(unknown[0])} is unknown here{meant}')
        return arguments, unknown

    def error(self, message: str) -> NoReturn:
        """Usage, the message, status 2."""
        found = re.search(r"invalid choice: '(.*?)' \(choose from (.*)\)", message)
        if found is not None:
            choices = re.findall(r'[\w-]+', found[2])
            near = nearest(found[1].lower(), choices)
            known = 'unknown' if near else f'not one of {", ".join(choices)}'
            message = f'{found[1]!r} is {known}{did_you_mean(near)}'
        super().error(message[:MOST_OF_AN_ERROR])


class Version(argparse.Action):
    """Prints the version, which is looked up only then."""

    def __init__(self, **options: Any) -> None:
        super().__init__(**options | {'nargs': 0})

    def __call__(self, parser: argparse.ArgumentParser, *_: object) -> NoReturn:
        """Prints and exits."""
        print(f'hexarm {_version()}')
        parser.exit()


def main(words: list[str] | None = None) -> int:
    """Runs one subcommand; see hexarm/cli/statuses.py for what it returns."""
    try:
        try:
            return _explained(words)
        finally:
            if sys.stdout is not None:
                sys.stdout.flush()
    except BrokenPipeError:
        _silence()
        return PIPE_CLOSED


def _explained(words: list[str] | None) -> int:
    """Runs one subcommand; an error is one line, and status 1 or 2."""
    try:
        return _run(words)
    except (ConfigError, InvalidInput, Refused) as error:
        print(f'hexarm: {error}', file=sys.stderr)
        return REFUSED
    except ManipulatorError as error:
        print(f'hexarm: {error}', file=sys.stderr)
    except ModuleNotFoundError as error:
        print(f'hexarm: {missing(error)}', file=sys.stderr)
    except KeyboardInterrupt:
        return INTERRUPTED
    return 1


def _silence() -> None:
    """Lets what is still buffered vanish: at its end Python would flush it, and complain."""
    nowhere = os.open(os.devnull, os.O_WRONLY)
    for stream in (sys.stdout, sys.stderr):
        with contextlib.suppress(AttributeError, OSError, ValueError):
            os.dup2(nowhere, stream.fileno())


def _run(words: list[str] | None) -> int:
    if '_ARGCOMPLETE' in os.environ:
        _complete(os.environ.get('COMP_LINE', '').split()[1:])
    parser = parser_for(sys.argv[1:] if words is None else words)
    arguments = parser.parse_args(words)
    if arguments.run is None:
        parser.print_help(sys.stderr)
        return REFUSED
    return int(arguments.run(arguments))


def _complete(words: list[str]) -> None:
    """Answers the shell that completes a line of these words, and ends; docs/cli.md."""
    with contextlib.suppress(ModuleNotFoundError):
        import argcomplete  # noqa: PLC0415 (an extra)

        argcomplete.autocomplete(parser_for(words))


def parser_for(words: list[str]) -> Parser:
    """The parser, with the arguments of the subcommand that the words begin with."""
    parser = Parser(
        prog='hexarm',
        description='Six-axis manipulators, from a pose target to servo pulses.',
        epilog=EXAMPLES,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument('--version', action=Version, help='show the version and exit')
    parser.set_defaults(run=None)
    commands = parser.add_subparsers(metavar='COMMAND', title='commands', action=Commands)
    declare(commands, words)
    return parser


def _version() -> str:
    """Of the installation, or of setup.py in a source tree that is not installed."""
    from importlib.metadata import PackageNotFoundError, version  # noqa: PLC0415 (slow, as above)

    try:
        return str(version('hexarm'))
    except PackageNotFoundError:
        setup = Path(__file__).resolve().parents[2] / 'setup.py'
        return str(re.findall(r"version='(.*?)'", setup.read_text())[0])


if __name__ == '__main__':
    sys.exit(main())
