"""Intra-process communication, which rclpy lacks: topics between nodes without the middleware.

Within a process, too, the middleware encodes, queues and decodes every message, which takes longer
than what the nodes compute of it. So a message is handed to the subscriptions of the same process
as it is; it is published for all others, and only while there are any.
"""

from collections import defaultdict, deque
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from rclpy.node import Node
from rclpy.qos import QoSProfile

from manipulator.errors import InvalidInput
from manipulator.nodes.steady_timer import ExecutorCall
from manipulator.nodes.subscriptions import FilteredCallback, decoded

MOST_BYTES = 10_000
"""Of a message: poses, and the joints of one machine, have less than 500."""

Take = Callable[[Any], object]


@dataclass
class _Topic:
    """Who takes its messages in this process; stamps of the newest that were published as well."""

    takers: list[Take] = field(default_factory=list)
    sent: tuple[tuple[int, int], ...] = ()

    def hand_over(self, message: Any) -> None:
        """To all of them; they must not change it."""
        for take in self.takers:
            take(message)


class IntraProcess:
    """The topics of nodes that one executor spins: it is made before them, one for them all."""

    def __init__(self) -> None:
        self._topics: defaultdict[str, _Topic] = defaultdict(_Topic)

    def subscribe(
        self, node: Node, kind: type, name: str, callback: FilteredCallback, qos: QoSProfile
    ) -> None:
        """Subscribes behind the message filter."""
        self.subscribe_unfiltered(node, kind, name, callback, callback.refuse_bytes, qos)

    def subscribe_unfiltered(
        self,
        node: Node,
        kind: type,
        name: str,
        take: Take,
        refuse: Callable[[InvalidInput], object],
        qos: QoSProfile,
    ) -> None:
        """Subscribes; `refuse` is called for bytes that are no such message, or too many."""
        topic = self._topics[node.resolve_topic_name(name)]

        def receive(serialized: bytes) -> None:
            try:
                message = decoded(serialized, kind, MOST_BYTES)
            except InvalidInput as error:
                refuse(error)
                return
            if _stamp(message) not in topic.sent:  # else it was handed over
                take(message)

        node.create_subscription(kind, name, receive, qos, raw=True)
        topic.takers.append(take)

    def publisher(
        self, node: Node, kind: type, name: str, qos: QoSProfile, is_from_thread: bool = False
    ) -> 'IntraProcessPublisher':
        """The publisher of a topic; is_from_thread: another thread than the executor's uses it."""
        topic = self._topics[node.resolve_topic_name(name)]
        publisher = node.create_publisher(kind, name, qos)
        crossing = _Crossing(node, topic, qos.depth) if is_from_thread else None
        return IntraProcessPublisher(publisher, topic, crossing)


class IntraProcessPublisher:
    """Made by IntraProcess; its messages may not be changed after they were published."""

    def __init__(self, publisher: Any, topic: _Topic, crossing: '_Crossing | None') -> None:
        self._publisher, self._topic, self._crossing = publisher, topic, crossing

    def publish(self, message: Any) -> None:
        """Hands it over, which calls the subscriptions' callbacks, and publishes it for others."""
        topic = self._topic
        if self._crossing is None:
            topic.hand_over(message)
        elif topic.takers:
            self._crossing.put(message)
        if self._publisher.get_subscription_count() > len(topic.takers):
            # Of ours, a reader of the middleware keeps as many as its depth, the newest.
            topic.sent = (*topic.sent, _stamp(message))[-self._publisher.qos_profile.depth :]
            self._publisher.publish(message)


def _stamp(message: Any) -> tuple[int, int]:
    """In nanoseconds no two messages of a topic have the same."""
    return message.header.stamp.sec, message.header.stamp.nanosec


class _Crossing:
    """From another thread into the executor's; of more than `depth` messages the newest."""

    def __init__(self, node: Node, topic: _Topic, depth: int) -> None:
        self._topic = topic
        self._waiting: deque[Any] = deque(maxlen=depth)
        self._call = ExecutorCall(node, self._hand_over)

    def put(self, message: Any) -> None:
        """Has it handed over soon."""
        self._waiting.append(message)
        self._call.request()

    def _hand_over(self) -> None:
        while self._waiting:
            self._topic.hand_over(self._waiting.popleft())
