"""`hexarm record [NAMESPACE]`: every message of a machine into an MCAP file, until Ctrl-C."""

import argparse
import math
import time
from pathlib import Path

from hexarm.cli.up import StopSignal
from hexarm.namespaces import namespace_of
from hexarm.recording.topics import Wanted, nothing, unheard
from manipulator.errors import ManipulatorError
from manipulator.formatting import counted


class NothingHeard(ManipulatorError):
    """A recording without a single message."""


def add_parser(commands: 'argparse._SubParsersAction[argparse.ArgumentParser]') -> None:
    """Declares the subcommand."""
    parser = commands.add_parser('record', help="write a machine's messages into an MCAP file")
    parser.add_argument(
        'namespace', nargs='?', type=namespace_of, default='hexapod', help='default: hexapod'
    )
    parser.add_argument(
        '-o', '--output', type=mcap_file, metavar='FILE.mcap', help='default: NAMESPACE-DATE.mcap'
    )
    parser.add_argument(
        '--for', type=positive, default=math.inf, dest='seconds', metavar='SECONDS',
        help='default: until Ctrl-C',
    )  # fmt: skip
    parser.add_argument(
        '--topics', nargs='+', default=(), metavar='TOPIC',
        help="only these; without a slash in front the namespace's (default: all of them)",
    )  # fmt: skip
    parser.add_argument(
        '--commands', action='store_true',
        help='commands that are published only once, too; see docs/recording.md, "Commands"',
    )  # fmt: skip
    parser.set_defaults(run=run)


def mcap_file(word: str) -> Path:
    """A path that ends in .mcap: by it Foxglove and `ros2 bag` tell what the file is."""
    path = Path(word).expanduser()
    if path.suffix != '.mcap':
        raise argparse.ArgumentTypeError(f'{word}: a recording ends in .mcap')
    return path


def positive(word: str) -> float:
    """A number of seconds."""
    try:
        number = float(word)
    except ValueError:
        number = math.nan
    if not number > 0:
        raise argparse.ArgumentTypeError(f'{word}: needs a number of seconds above 0')
    return number


def run(arguments: argparse.Namespace) -> int:
    """Records; status 0 with a finished file, 1 without a message or when writing failed."""
    from hexarm.recording.bag import Bag  # noqa: PLC0415 (needs mcap)
    from hexarm.recording.session import Control, record  # noqa: PLC0415 (needs ROS)

    namespace = arguments.namespace
    when = time.strftime('%Y%m%d-%H%M%S')
    path = arguments.output or Path(f'{namespace.replace("/", "_")}-{when}.mcap')
    wanted = Wanted(namespace, arguments.topics, arguments.commands)
    stop = StopSignal()
    begin = time.monotonic()
    with Bag(path) as bag:
        _say(f'waiting for publishers of {_asked(wanted)}')
        control = Control(
            begin + arguments.seconds,
            stop.check,
            lambda: _say(f'recording /{namespace} into {path}; Ctrl-C ends it'),
            lambda there, domain: _say(
                f'{nothing(namespace, unheard(wanted.names, (), there), there, domain)}; '
                'still waiting, Ctrl-C ends it'
            ),
        )
        there, domain = record(bag, namespace, wanted, control)
    lines = unheard(wanted.names, bag.counts, there)
    space = f'/{namespace}/'
    if not any(topic.startswith(space) or topic in wanted.names for topic in bag.counts):
        path.unlink()
        raise NothingHeard(nothing(namespace, lines, there, domain))
    for line in lines:
        print(line)
    took = time.monotonic() - begin
    print(
        f'{path}: {counted(bag.counts.total(), "message")} of '
        f'{counted(len(bag.counts), "topic")} in {took:.1f} s, {bag.size / 1e6:.1f} MB'
    )
    return 0


def _asked(wanted: Wanted) -> str:
    return ', '.join(wanted.names) or f'/{wanted.namespace}'


def _say(line: str) -> None:
    print(line, flush=True)
