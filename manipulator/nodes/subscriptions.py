"""Subscriptions behind the message filter, by size before decoding, and from one hand alone.

Decoding a message of megabytes takes a second in which no other thread of the process gets a turn,
one that receives a STOP among them. So messages without a bound on their length (`raw=True`) are
rejected by their size first.
"""

import inspect
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from rclpy.node import Node
from rclpy.qos import QoSProfile
from rclpy.serialization import deserialize_message
from std_msgs.msg import Header

from manipulator.errors import InvalidInput, ManipulatorError
from manipulator.formatting import counted
from manipulator.message_filter import MessageFilter
from manipulator.nodes.messages import seconds
from manipulator.teleop.arbiter import SoleSource


def decoded(serialized: bytes, kind: type, most_bytes: int) -> Any:
    """The message; InvalidInput where it is too large, or no message of this kind."""
    if len(serialized) > most_bytes:
        raise InvalidInput(f'{len(serialized)} bytes, at most {most_bytes}')
    try:
        return deserialize_message(serialized, kind)
    except RuntimeError as error:  # what rclpy's own error derives from
        raise InvalidInput(
            f'{counted(len(serialized), "byte")} that are no {kind.__name__}'
        ) from error


@dataclass(frozen=True)
class RawMessage:
    """A message of which only the header has been decoded; an empty one where it cannot be."""

    header: Header
    serialized: bytes


def raw_message(serialized: bytes, most_bytes: int) -> RawMessage:
    """A message with its header decoded, which is what it begins with: at most 0.3 ms.

    most_bytes: of a good message, of which a longer one is not read further.
    """
    begin = serialized[:most_bytes]
    try:
        return RawMessage(decoded(begin, Header, most_bytes), serialized)
    except InvalidInput:
        return RawMessage(Header(), serialized)


CLOCK_START = time.time() - time.monotonic()
"""Receipt times are monotonic, but read like the system's clock at the start: it may be set."""


class FilteredCallback:
    """The messages of one topic, as its MessageFilter lets them through.

    accept is called with each message that is fresh; a ManipulatorError that it raises is
    remembered for /diagnostics, and reported by `refuse`, or else logged (throttled).
    """

    def __init__(
        self,
        node: Node,
        topic: str,
        accept: Callable[[Any], None],
        refuse: Callable[[Any, ManipulatorError], None] | None = None,
    ) -> None:
        self.topic = topic
        self._node = node
        self._accept = accept
        self._refuse = refuse
        self._filter = MessageFilter(CLOCK_START)
        self._was_offset_reported = False
        self.refused_at = float('-inf')
        """When a message was not accepted for the last time (s, monotonic)."""

    def __call__(self, message: Any) -> None:
        """The subscription's callback."""
        stamp = seconds(message.header.stamp)
        if stamp == 0.0:
            text = f'{self.topic}: a stamp of zero is taken as now'
            self._node.get_logger().info(text, once=True)
        error = self._filter.take(stamp, lambda: self._accept(message), time.monotonic())
        self._report_offset()
        if error is not None:
            self._report(message, error)

    def refuse(self, message: Any, error: ManipulatorError) -> None:
        """Refuses a message that was accepted at first."""
        self._filter.refuse(error)
        self._report(message, error)

    def refuse_bytes(self, error: InvalidInput) -> None:
        """Refuses bytes that are no message."""
        self.refuse(None, error)

    @property
    def refused(self) -> int:
        """How many messages were not accepted."""
        return self._filter.refused

    @property
    def last_refusal(self) -> str:
        """Why the last of them was not, '' before the first."""
        return self._filter.last_refusal

    @property
    def age(self) -> float:
        """Seconds since the last good message, ∞ before the first."""
        return self._filter.age(time.monotonic())

    @property
    def lateness(self) -> float:
        """Of the message that is being accepted, in seconds: see MessageFilter."""
        return self._filter.lateness

    def _report(self, message: Any, error: ManipulatorError) -> None:
        self.refused_at = time.monotonic()
        if self._refuse is not None:
            self._refuse(message, error)
            return
        text = f'{self.topic}: {self.last_refusal}'
        self._node.get_logger().warning(text, throttle_duration_sec=1.0)

    def _report_offset(self) -> None:
        offset = self._filter.clock_offset
        if offset and not self._was_offset_reported:
            self._was_offset_reported = True
            text = f'{self.topic}: the clock of its source differs from ours by {offset:.3f} s'
            self._node.get_logger().warning(text)


class SoleSubscription:
    """Hands every message to `accept`, which reads `conflict` first.

    is_continuous: see SoleSource. is_raw: messages are handed over encoded.

    rclpy gives a callback of two arguments the message and what is known of it. The EventsExecutor
    of rclpy 7.1 hands them over as one pair: so this object has the signature of a callback of two
    arguments, and takes both forms.
    """

    __signature__ = inspect.signature(lambda message, info: None)

    def __init__(
        self,
        node: Node,
        message_type: type,
        topic: str,
        accept: Callable[[Any], None],
        qos: QoSProfile,
        is_continuous: bool = False,
        is_raw: bool = False,
    ) -> None:
        self._accept = accept
        self._source = SoleSource(is_continuous)
        self._subscription = node.create_subscription(message_type, topic, self, qos, raw=is_raw)
        self.topic = str(self._subscription.topic_name)

    def __call__(self, *received: Any) -> None:
        """The subscription's callback."""
        message, info = received if len(received) == 2 else received[0]
        self._source = self._source.receive(
            info['publication_sequence_number'],
            self._subscription.get_publisher_count(),
            time.monotonic(),
        )
        self._accept(message)

    @property
    def conflict(self) -> str:
        """Why no message counts at present, '' where they come from one publisher."""
        if self._source.is_mixed(time.monotonic()):
            return f'more than one publisher sends on {self.topic}'
        return ''
