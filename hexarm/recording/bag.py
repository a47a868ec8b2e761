"""One MCAP file being written, as Foxglove and `ros2 bag` read it (profile `ros2`)."""

import contextlib
import os
from collections import Counter
from pathlib import Path

from mcap.well_known import MessageEncoding, Profile, SchemaEncoding
from mcap.writer import CompressionType, Writer

from hexarm.recording.log_parser import schema_text
from hexarm.recording.sink import Topic
from manipulator.errors import InvalidInput, ManipulatorError

CHUNK_BYTES = 1 << 20


class NotWritten(ManipulatorError, OSError):
    """A recording that cannot go on: the file's name, and why."""


class Bag:
    """A new file, a Sink; a context manager that finishes it. Messages stay as they came, in CDR.

    All that was written before the last `flush` survives the end of the process.
    """

    def __init__(self, path: Path) -> None:
        """InvalidInput where the file exists or cannot be written."""
        self.path = path
        self.counts: Counter[str] = Counter()
        self._channels: dict[str, int] = {}
        self._schemas: dict[str, int] = {}
        try:
            self._file = path.open('xb')
        except OSError as error:
            raise InvalidInput(f'{path}: {_reason(error)}') from error
        self._writer = Writer(self._file, CHUNK_BYTES, CompressionType.ZSTD)
        self._writer.start(Profile.ROS2, 'hexarm')

    def __enter__(self) -> 'Bag':
        """The bag itself."""
        return self

    def __exit__(self, kind: type | None, *exception: object) -> None:
        """Writes index and statistics; after a failure to write only closes the file."""
        if kind is not None and issubclass(kind, NotWritten):
            with contextlib.suppress(OSError):
                self._file.close()
            return
        try:
            self._writer.finish()
            self._file.close()
        except OSError as error:
            raise self._failure(error) from error

    def add_type(self, type_name: str) -> None:
        """Makes a message type known; UnknownType where its definition is not installed."""
        if type_name not in self._schemas:
            self._schemas[type_name] = self._writer.register_schema(
                type_name, SchemaEncoding.ROS2, schema_text(type_name).encode()
            )

    def add_topic(self, topic: Topic) -> None:
        """Makes a topic known, whose type is."""
        self._channels[topic.name] = self._writer.register_channel(
            topic.name,
            MessageEncoding.CDR,
            self._schemas[topic.type_name],
            {'offered_qos_profiles': topic.qos, 'topic_type_hash': topic.type_hash},
        )

    def write(self, topic: str, message: bytes, at: int) -> None:
        """Adds a serialized message that was received at that time, ns since 1970."""
        try:
            self._writer.add_message(self._channels[topic], at, message, at)
        except OSError as error:
            raise self._failure(error) from error
        self.counts[topic] += 1

    def flush(self) -> None:
        """Hands everything to the operating system."""
        try:
            self._writer.flush()
        except OSError as error:
            raise self._failure(error) from error

    @property
    def size(self) -> int:
        """Bytes in the file by now."""
        return self.path.stat().st_size

    def _failure(self, error: OSError) -> NotWritten:
        return NotWritten(
            f'{self.path}: {_reason(error)}; what was written before, '
            f'{self.size / 1e6:.1f} MB, can be read'
        )


def _reason(error: OSError) -> str:
    if isinstance(error, FileExistsError):
        return 'exists already, and is not overwritten'
    return os.strerror(error.errno) if error.errno else str(error)
