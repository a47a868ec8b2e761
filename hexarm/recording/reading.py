"""A recording without ROS: the messages of an MCAP file, and tables of comma-separated values.

A file that was torn off ends at the tear.
"""

import csv
import struct
from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any

from mcap.exceptions import EndOfFile, InvalidMagic, McapError
from mcap.records import Channel, Message, Schema
from mcap.stream_reader import StreamReader
from mcap_ros2.decoder import DecoderFactory
from zstandard import ZstdError

from hexarm.recording.run_summary import POSE_COLUMNS, RunSummary, Series
from manipulator.errors import InvalidInput

TORN = (EndOfFile, struct.error)
"""What mcap's reader raises where the file ends within a record."""

DAMAGED = (
    *(McapError, ZstdError, struct.error, ValueError, LookupError, NameError, AttributeError),
    *(TypeError, RuntimeError, ArithmeticError, MemoryError),
)
"""What mcap, its decompressors and its decoder raise for bytes that were changed."""


def messages(path: Path, is_needed: Callable[[str], bool]) -> Iterator[tuple[str, float, Any]]:
    """Topic, time of receipt (s) and message of each needed topic, in the order of the file.

    Takes a bag's folder, too. InvalidInput for what is no MCAP recording of ROS 2 messages, or
    damaged.
    """
    try:
        yield from _decoded(path, is_needed)
    except InvalidInput:
        raise
    except DAMAGED as error:
        raise InvalidInput(f'{path} is damaged: {error}') from error


def _decoded(path: Path, is_needed: Callable[[str], bool]) -> Iterator[tuple[str, float, Any]]:
    factory = DecoderFactory()
    schemas: dict[int, Schema] = {}
    channels: dict[int, Channel] = {}
    for record in _records(mcap_of(path)):
        if isinstance(record, Schema):
            schemas[record.id] = record
        elif isinstance(record, Channel):
            channels[record.id] = record
        elif isinstance(record, Message) and is_needed(channels[record.channel_id].topic):
            channel = channels[record.channel_id]
            decode = factory.decoder_for(channel.message_encoding, schemas.get(channel.schema_id))
            if decode is None:
                raise InvalidInput(f'{path}: {channel.topic} holds no ROS 2 messages')
            yield channel.topic, record.log_time * 1e-9, decode(record.data)


def mcap_of(path: Path) -> Path:
    """The file itself, or the one in a bag's folder; InvalidInput names what is there instead."""
    if not path.is_dir():
        return path
    found = sorted(path.glob('*.mcap'))
    if len(found) == 1:
        return found[0]
    if list(path.glob('*.db3')):
        raise InvalidInput(f'{path} is an SQLite bag: turn it into MCAP with `ros2 bag convert`')
    raise InvalidInput(f'{path} is a folder with {len(found)} MCAP files: name one of them')


def _records(path: Path) -> Iterator[Any]:
    try:
        with path.open('rb') as file:
            try:
                yield from StreamReader(file, validate_crcs=True).records
            except TORN:
                return
    except OSError as error:
        raise InvalidInput(f'{path}: {error.strerror or error}') from error
    except InvalidMagic as error:
        raise InvalidInput(f'{path} is not an MCAP file') from error


def write(summary: RunSummary, folder: Path) -> list[Path]:
    """One file a table into the folder, which is made; OSError where that cannot be done."""
    folder.mkdir(parents=True, exist_ok=True)
    joints = summary.joint_names
    tables = {
        'setpoint': (POSE_COLUMNS, summary.setpoint),
        'pose': (POSE_COLUMNS, summary.pose),
        'goals': (POSE_COLUMNS, summary.goals),
        'pose_error': (('distance_m', 'angle_rad'), summary.pose_error),
        'joint_command': (joints, summary.joint_command),
        'joint_states': (joints, summary.joint_states),
    }
    written = [
        _table(folder / f'{name}.csv', ('time_s', *columns), _rows(series))
        for name, (columns, series) in tables.items()
    ]
    events = ((f'{e.time:.4f}', e.source, e.what, e.count, e.reason) for e in summary.events)
    heads = ('time_s', 'source', 'what', 'count', 'reason')
    return [*written, _table(folder / 'events.csv', heads, events)]


def _rows(series: Series) -> Iterable[Sequence[object]]:
    for time, values in zip(series.times, series.values, strict=True):
        yield (f'{time:.4f}', *(f'{value:.9g}' for value in values))


def _table(path: Path, heads: Sequence[str], rows: Iterable[Sequence[object]]) -> Path:
    with path.open('w', newline='', encoding='utf-8') as file:
        writer = csv.writer(file)
        writer.writerow(heads)
        writer.writerows(rows)
    return path
