"""`hexarm record [NAMESPACE]`: every message of a machine into an MCAP file, until Ctrl-C."""

import argparse
import json
import math
import sys
import time
from collections.abc import Collection, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, TextIO

from hexarm.namespaces import namespace_of
from hexarm.recording.topics import TopicSelection, missing_topics, nothing_recorded
from manipulator.errors import ManipulatorError
from manipulator.formatting import counted
from manipulator.nodes.stop_signal import StopSignal

if TYPE_CHECKING:
    from hexarm.recording.bag import Bag


class NothingRecorded(ManipulatorError):
    """A recording without a single message."""


def add_parser(commands: 'argparse._SubParsersAction[argparse.ArgumentParser]') -> None:
    """Declares the subcommand."""
    parser = commands.add_parser('record')
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
    parser.add_argument('--json', action='store_true', help='answer for programs, at the end')
    parser.set_defaults(run=run)


def mcap_file(name: str) -> Path:
    """A path that ends in .mcap: by it Foxglove and `ros2 bag` recognise the file."""
    path = Path(name).expanduser()
    if path.suffix != '.mcap':
        raise argparse.ArgumentTypeError(f'{name}: a recording ends in .mcap')
    return path


def positive(name: str) -> float:
    """A number of seconds."""
    try:
        number = float(name)
    except ValueError:
        number = math.nan
    if not number > 0:
        raise argparse.ArgumentTypeError(f'{name}: needs a number of seconds above 0')
    return number


def run(arguments: argparse.Namespace) -> int:
    """Records; status 0 with a finished file, 1 without a message or when writing failed."""
    from hexarm.recording.bag import Bag  # noqa: PLC0415 (needs mcap)
    from hexarm.recording.session import Control, record  # noqa: PLC0415 (needs ROS)

    namespace = arguments.namespace
    when = time.strftime('%Y%m%d-%H%M%S')
    path = arguments.output or Path(f'{namespace.replace("/", "_")}-{when}.mcap')
    selection = TopicSelection(namespace, arguments.topics, arguments.commands)
    stop, out = StopSignal(), sys.stderr if arguments.json else sys.stdout
    begin = time.monotonic()
    with Bag(path) as bag:
        _say(f'waiting for publishers of {_requested(selection)}', out)
        control = Control(
            begin + arguments.seconds,
            stop.check,
            lambda: _say(f'recording /{namespace} into {path}; Ctrl-C ends it', out),
            lambda there, domain: _say(
                f'{_reason(selection, [], there, domain)}; still waiting, Ctrl-C ends it', out
            ),
        )
        there, domain = record(bag, namespace, selection, control)
    lines = missing_topics(selection.names, bag.counts, there)
    space = f'/{namespace}/'
    if not any(topic.startswith(space) or topic in selection.names for topic in bag.counts):
        path.unlink()
        raise NothingRecorded(_reason(selection, bag.counts, there, domain))
    summary = _summary(bag, path, time.monotonic() - begin)
    print(json.dumps(summary) if arguments.json else '\n'.join([*lines, _in_words(summary)]))
    return 0


def _summary(bag: 'Bag', path: Path, seconds: float) -> dict[str, Any]:
    return {'file': str(path), 'seconds': seconds, 'bytes': bag.size, 'counts': dict(bag.counts)}


def _in_words(summary: Mapping[str, Any]) -> str:
    counts = summary['counts']
    return (
        f'{summary["file"]}: {counted(sum(counts.values()), "message")} of '
        f'{counted(len(counts), "topic")} in {summary["seconds"]:.1f} s, '
        f'{summary["bytes"] / 1e6:.1f} MB'
    )


def _reason(
    selection: TopicSelection, received: Collection[str], there: set[str], domain: int
) -> str:
    """Why nothing is recorded."""
    lines = missing_topics(selection.names, received, there)
    return nothing_recorded(selection.namespace, lines, there, domain)


def _requested(selection: TopicSelection) -> str:
    return ', '.join(selection.names) or f'/{selection.namespace}'


def _say(line: str, out: TextIO) -> None:
    print(line, file=out, flush=True)
