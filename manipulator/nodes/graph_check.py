"""What is wrong with the graph around a node: missing subscribers, publishers not received.

ROS silently drops messages of another type or of a weaker quality of service than requested, and
some topics may have only one publisher. A check takes about 50 µs a topic (measured on a computer
of two cores).
"""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field

from rclpy.node import Node
from rclpy.qos import (
    DurabilityPolicy,
    QoSCompatibility,
    QoSProfile,
    ReliabilityPolicy,
    qos_check_compatible,
)
from rclpy.topic_endpoint_info import TopicEndpointInfo

PATIENCE = 3.0
"""Seconds that nodes may take to find each other."""


def place(node: Node) -> str:
    """A node's namespace and domain, as '/hexapod on ROS domain 0'."""
    return f'{node.get_namespace()} on ROS domain {node.context.get_domain_id()}'


@dataclass
class SubscriberCheck:
    """Reports whether a machine subscribes in `place`; times are monotonic, in seconds."""

    place: str
    since: float
    reported: bool | None = field(default=None, init=False)

    def update(self, has_subscribers: bool, now: float) -> str:
        """A line when a machine begins to subscribe, or has not for PATIENCE; else ''."""
        if has_subscribers:
            self.since = now
        is_new = has_subscribers is not self.reported
        if not is_new or (not has_subscribers and now - self.since < PATIENCE):
            return ''
        self.reported = has_subscribers
        if has_subscribers:
            return f'a machine subscribes in {self.place}'
        return f'no machine subscribes in {self.place}: is it started there? {self._hint}'.rstrip()

    @property
    def _hint(self) -> str:
        is_root = self.place.startswith('/ ')
        return 'Another namespace: --ros-args -r __ns:=/hexapod' if is_root else ''


MOST_NAMED = 4
"""Nodes that a message names; of more, only the number."""


@dataclass(frozen=True)
class Received:
    """A topic that is received for a node: by its own subscription, or beside it."""

    topic: str
    message_type: type
    qos: QoSProfile


def received_by(node: Node) -> Iterator[Received]:
    """What the node's own subscriptions receive."""
    for subscription in node.subscriptions:
        yield Received(subscription.topic_name, subscription.msg_type, subscription.qos_profile)


def crowds(node: Node, topics: Iterable[str]) -> list[str]:
    """A text for each of the topics that has more than one publisher, with their nodes."""
    found = []
    for topic in topics:
        publishers = _publishers(node, topic)
        if len(publishers) > 1:
            names = _names(publishers)
            found.append(f'{len(publishers)} publishers on {topic}, which must have one: {names}')
    return found


def unreceived(node: Node, topics: Iterable[Received]) -> list[str]:
    """A text for each publisher on the topics that is not received, with what to change."""
    found = []
    for topic in topics:
        for publisher in _publishers(node, topic.topic):
            remedy = _remedy(publisher, topic)
            if remedy:
                found.append(f'{_short(node, topic.topic)}: {_names([publisher])} {remedy}')
    return found


def _publishers(node: Node, topic: str) -> Sequence[TopicEndpointInfo]:
    return list(node.get_publishers_info_by_topic(node.resolve_topic_name(topic)))


def _remedy(publisher: TopicEndpointInfo, topic: Received) -> str:
    """What is wrong and what helps, '' where the publisher's messages are received."""
    type_name = _type_name(topic.message_type)
    if publisher.topic_type != type_name:
        return f'publishes {publisher.topic_type}, which is not received: publish {type_name}'
    compatibility, reason = qos_check_compatible(publisher.qos_profile, topic.qos)
    if compatibility != QoSCompatibility.ERROR:
        return ''
    remedies = _stronger(publisher.qos_profile, topic.qos)
    if not remedies:
        return f'is not received: {reason}'
    return f'is not received: its quality of service must be {" and ".join(remedies)}'


def _stronger(offered: QoSProfile, requested: QoSProfile) -> list[str]:
    """What the subscription requests and the publisher does not offer."""
    reliable = requested.reliability, offered.reliability
    latched = requested.durability, offered.durability
    found = []
    if reliable == (ReliabilityPolicy.RELIABLE, ReliabilityPolicy.BEST_EFFORT):
        found.append('reliable')
    if latched == (DurabilityPolicy.TRANSIENT_LOCAL, DurabilityPolicy.VOLATILE):
        found.append('transient local')
    return found


def _type_name(message_type: type) -> str:
    """As the graph writes it: geometry_msgs/msg/Twist."""
    package, kind = message_type.__module__.split('.')[:2]
    return f'{package}/{kind}/{message_type.__name__}'


def _names(publishers: Sequence[TopicEndpointInfo]) -> str:
    names = [f'{p.node_namespace.rstrip("/")}/{p.node_name}' for p in publishers]
    shown = ', '.join(
        'an unknown node' if 'UNKNOWN' in name else name for name in names[:MOST_NAMED]
    )
    return shown if len(names) <= MOST_NAMED else f'{shown} and {len(names) - MOST_NAMED} more'


def _short(node: Node, topic: str) -> str:
    """Relative to the node's namespace where it lies in it."""
    return topic.removeprefix(f'{node.get_namespace().rstrip("/")}/')
