"""What every subscription does with a message: reject the stale, name the bad, keep the last."""

import time
from collections.abc import Callable
from typing import Any

from rclpy.node import Node

from manipulator.errors import ManipulatorError
from manipulator.nodes.messages import seconds
from manipulator.stamps import NOTABLE_OFFSET, StampGate

CLOCK_START = time.time() - time.monotonic()
"""Receipt times are monotonic, but read like the system's clock at the start: it may be set."""

LONGEST_REASON = 400
"""Characters of a refusal that are logged and kept: a message's own words may be megabytes."""


class Intake:
    """The messages of one topic: counts, the last refusal, the time of the last good one.

    accept is called with each message that is fresh; a ManipulatorError that it raises is logged
    (throttled), remembered for /diagnostics and handed to `refuse`, if there is one. Nothing else
    happens: the last good command stays.
    """

    def __init__(
        self,
        node: Node,
        topic: str,
        accept: Callable[[Any], None],
        refuse: Callable[[Any, ManipulatorError], None] | None = None,
    ) -> None:
        self.topic = topic
        self.refused = 0
        self.last_refusal = ''
        self.last_good = float('-inf')
        self._node = node
        self._accept = accept
        self._refuse = refuse
        self._gate = StampGate()
        self._was_offset_reported = False

    def __call__(self, message: Any) -> None:
        """The subscription's callback."""
        try:
            self._check_stamp(message)
            self._accept(message)
        except ManipulatorError as error:
            self.refuse(message, error)
        else:
            self.last_good = time.monotonic()

    def refuse(self, message: Any, error: ManipulatorError) -> None:
        """What becomes of a message that was not accepted, or not in the end."""
        self.refused += 1
        self.last_refusal = str(error)[:LONGEST_REASON]
        text = f'{self.topic}: {self.last_refusal}'
        self._node.get_logger().warning(text, throttle_duration_sec=1.0)
        if self._refuse is not None:
            self._refuse(message, error)

    @property
    def age(self) -> float:
        """Seconds since the last good message, ∞ before the first."""
        return time.monotonic() - self.last_good

    def _check_stamp(self, message: Any) -> None:
        stamp = seconds(message.header.stamp)
        if stamp == 0.0:
            self._node.get_logger().info(
                f'{self.topic}: a stamp of zero is taken as now', once=True
            )
            return
        self._gate.admit(stamp, time.monotonic() + CLOCK_START)
        offset = self._gate.offset or 0.0
        if abs(offset) > NOTABLE_OFFSET and not self._was_offset_reported:
            self._was_offset_reported = True
            text = f'{self.topic}: the clock of its source differs from ours by {-offset:.3f} s'
            self._node.get_logger().warning(text)
