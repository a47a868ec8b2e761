"""A subscription's callback: the message filter, with the node's clock and log."""

import time
from collections.abc import Callable
from typing import Any

from rclpy.node import Node

from manipulator.errors import ManipulatorError
from manipulator.message_filter import MessageFilter
from manipulator.nodes.messages import seconds

CLOCK_START = time.time() - time.monotonic()
"""Receipt times are monotonic, but read like the system's clock at the start: it may be set."""


class Intake:
    """The messages of one topic, as its MessageFilter lets them through.

    accept is called with each message that is fresh; a ManipulatorError that it raises is logged
    (throttled), remembered for /diagnostics and handed to `refuse`, if there is one.
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
        """What becomes of a message that was accepted, but not in the end."""
        self._filter.refuse(error)
        self._report(message, error)

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

    def _report(self, message: Any, error: ManipulatorError) -> None:
        text = f'{self.topic}: {self.last_refusal}'
        self._node.get_logger().warning(text, throttle_duration_sec=1.0)
        if self._refuse is not None:
            self._refuse(message, error)

    def _report_offset(self) -> None:
        offset = self._filter.clock_offset
        if offset and not self._was_offset_reported:
            self._was_offset_reported = True
            text = f'{self.topic}: the clock of its source differs from ours by {offset:.3f} s'
            self._node.get_logger().warning(text)
