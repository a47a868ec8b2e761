"""A machine's messages to Foxglove as they come: what a recording would hold, over a WebSocket."""

from collections import Counter
from typing import Any

import foxglove

from hexarm.recording.log_parser import schema_text
from hexarm.recording.sink import Topic
from manipulator.errors import Refused


class FoxgloveServer:
    """A server that Foxglove connects to; a context manager that closes it. See Sink."""

    def __init__(self, name: str, host: str, port: int) -> None:
        """Refused where the port cannot be used."""
        self.counts: Counter[str] = Counter()
        self._schemas: dict[str, Any] = {}
        self._channels: dict[str, Any] = {}
        self._context = foxglove.Context()
        try:
            self._server = foxglove.start_server(
                name=name, host=host, port=port, context=self._context
            )
        except (OSError, RuntimeError) as error:
            raise Refused(f'cannot serve on {host}, port {port}: {error}') from error
        self.address = f'ws://{host}:{self._server.port}'

    def __enter__(self) -> 'FoxgloveServer':
        """The server itself."""
        return self

    def __exit__(self, *exception: object) -> None:
        """Closes all connections."""
        self._server.stop()

    def add_type(self, type_name: str) -> None:
        """Makes a message type known; UnknownType where its definition is not installed."""
        if type_name not in self._schemas:
            self._schemas[type_name] = foxglove.Schema(
                name=type_name, encoding='ros2msg', data=schema_text(type_name).encode()
            )

    def add_topic(self, topic: Topic) -> None:
        """Offers a topic, whose type is known."""
        self._channels[topic.name] = foxglove.Channel(
            topic.name,
            schema=self._schemas[topic.type_name],
            message_encoding='cdr',
            context=self._context,
        )

    def write(self, topic: str, message: bytes, at: int) -> None:
        """Sends a serialized message that was received at that time, ns since 1970."""
        self._channels[topic].log(message, log_time=at)
        self.counts[topic] += 1

    def flush(self) -> None:
        """Nothing waits."""
