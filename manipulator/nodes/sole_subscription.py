"""A subscription to what one person's hand sends: it notices when two publishers send at once."""

import inspect
import time
from collections.abc import Callable
from typing import Any

from rclpy.node import Node
from rclpy.qos import QoSProfile

from manipulator.teleop.sole_source import SoleSource


class SoleSubscription:
    """Hands every message to `accept`, which asks for `trouble` first.

    is_continuous: see SoleSource.

    rclpy gives a callback of two arguments the message and what is known of it. The EventsExecutor
    of rclpy 7.1 hands them over as one pair: so this object looks like a callback of two
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
    ) -> None:
        self._accept = accept
        self._source = SoleSource(is_continuous)
        self._subscription = node.create_subscription(message_type, topic, self, qos)
        self.topic = str(self._subscription.topic_name)

    def __call__(self, *received: Any) -> None:
        """The subscription's callback."""
        message, info = received if len(received) == 2 else received[0]
        self._source = self._source.hear(
            info['publication_sequence_number'],
            self._subscription.get_publisher_count(),
            time.monotonic(),
        )
        self._accept(message)

    @property
    def trouble(self) -> str:
        """Why no message counts at present, '' where they come from one publisher."""
        if self._source.is_mixed(time.monotonic()):
            return f'more than one publisher sends on {self.topic}'
        return ''
