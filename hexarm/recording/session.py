"""The recorder: finds topics, and passes each message on as it came until it is stopped.

It subscribes with a quality of service that every publisher serves, and records the offered one.
"""

import contextlib
import math
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from importlib import import_module
from typing import Any

import rclpy
import yaml
from rclpy.duration import Duration
from rclpy.experimental import EventsExecutor
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from rclpy.signals import SignalHandlerOptions
from rclpy.utilities import try_shutdown

from hexarm.recording.log_parser import UnknownType
from hexarm.recording.sink import Sink, Topic
from hexarm.recording.topics import TopicSelection, missing_topics
from manipulator.nodes.stop_signal import Interrupted

DEPTH = 500
"""Messages that may wait: half a second of the fastest topic on a busy computer."""


def subscription_qos(
    publishers: Sequence[QoSProfile], subscribers: Sequence[QoSProfile]
) -> QoSProfile:
    """What every publisher can serve; before there is one, what other subscribers request."""
    offers = publishers or subscribers
    every = all if publishers else any
    is_reliable = every(o.reliability == ReliabilityPolicy.RELIABLE for o in offers)
    is_latched = every(o.durability == DurabilityPolicy.TRANSIENT_LOCAL for o in offers)
    return QoSProfile(
        depth=DEPTH,
        reliability=ReliabilityPolicy.RELIABLE if is_reliable else ReliabilityPolicy.BEST_EFFORT,
        durability=DurabilityPolicy.TRANSIENT_LOCAL if is_latched else DurabilityPolicy.VOLATILE,
    )


def offered(publishers: Sequence[QoSProfile]) -> str:
    """The publishers' profiles as YAML with the names of rosbag2's metadata, version 9."""
    different = {str(offer): offer for offer in map(_as_metadata, publishers)}
    return yaml.safe_dump(list(different.values()), sort_keys=False) if different else ''


def _as_metadata(profile: QoSProfile) -> dict[str, object]:
    # Discovery provides neither history nor depth: at least one message must be kept.
    return {
        'history': 'keep_last',
        'depth': max(profile.depth, 1),
        'reliability': profile.reliability.name.lower(),
        'durability': profile.durability.name.lower(),
        'deadline': _span(profile.deadline),
        'lifespan': _span(profile.lifespan),
        'liveliness': profile.liveliness.name.lower(),
        'liveliness_lease_duration': _span(profile.liveliness_lease_duration),
        'avoid_ros_namespace_conventions': bool(profile.avoid_ros_namespace_conventions),
    }


def _span(duration: Duration) -> dict[str, int]:
    sec, nsec = divmod(duration.nanoseconds, 10**9)
    return {'sec': sec, 'nsec': nsec}


class Recorder:
    """Subscribes to the selected topics that exist, at each update."""

    def __init__(self, node: Node, selection: TopicSelection, sink: Sink) -> None:
        self._node, self._selection, self._sink = node, selection, sink
        self._subscriptions: dict[str, Any] = {}
        self._qos: dict[str, QoSProfile] = {}
        self._unknown: set[str] = set()
        self.there: set[str] = set()
        """Every topic that was seen."""
        self._is_settled = False

    def update(self, now: float) -> None:
        """Joins and leaves topics; again where publishers offer another quality of service."""
        before = dict(self._qos)
        self._update(now)
        self._is_settled = self._qos == before

    def _update(self, now: float) -> None:
        for name, types in self._node.get_topic_names_and_types():
            self.there.add(name)
            if name in self._unknown:
                continue
            publishers = self._node.get_publishers_info_by_topic(name)
            if not self._selection.may_join(name, [p.node_name for p in publishers], now):
                self._leave(name)
                continue
            try:
                self._join(name, types[0], publishers)
            except UnknownType as error:
                self._unknown.add(name)
                self._node.get_logger().warning(f'{name} is not recorded: {error}')

    def is_ready(self, every: bool) -> bool:
        """Whether we have met a publisher of each topic, or of any, and no topic is new.

        A machine's topics are discovered one after another, many by a subscriber first.
        """
        return self._is_settled and self._is_matched(every)

    def _is_matched(self, every: bool) -> bool:
        met = self.met
        own = filter(self._selection.is_own, self._subscriptions)
        is_command, publishers = self._selection.is_command, self._node.count_publishers
        expected = {name for name in own if not is_command(name) or publishers(name)}
        return bool(met) and (expected <= met or not every)

    @property
    def met(self) -> set[str]:
        """The topics of the machine of which we have met a publisher."""
        own = {n: s for n, s in self._subscriptions.items() if self._selection.is_own(n)}
        return {name for name, subscription in own.items() if subscription.get_publisher_count()}

    def warn(self) -> None:
        """Logs the requested topics that do not exist."""
        names = [name for name in self._selection.names if name not in self.there]
        for line in missing_topics(names, (), self.there):
            self._node.get_logger().warning(line)

    def _join(self, name: str, type_name: str, publishers: list[Any]) -> None:
        offers = [p.qos_profile for p in publishers]
        if name in self._subscriptions and not offers:
            return
        qos = subscription_qos(offers, self._others(name))
        if qos == self._qos.get(name):
            return
        kind = message_class(type_name)
        self._sink.add_type(type_name)
        self._leave(name)
        self._qos[name] = qos
        self._subscriptions[name] = self._node.create_subscription(
            kind, name, lambda message: self._keep(name, type_name, message), qos, raw=True
        )

    def _keep(self, name: str, type_name: str, message: bytes) -> None:
        if name not in self._sink.counts:
            # Only now, with a publisher, is it known what is offered.
            publishers = self._node.get_publishers_info_by_topic(name)
            type_hash = str(publishers[0].topic_type_hash) if publishers else ''
            offers = offered([p.qos_profile for p in publishers])
            self._sink.add_topic(Topic(name, type_name, offers, type_hash))
        self._sink.write(name, message, time.time_ns())

    def _others(self, name: str) -> list[QoSProfile]:
        """What the other subscribers of the topic request."""
        found = self._node.get_subscriptions_info_by_topic(name)
        return [s.qos_profile for s in found if s.node_name != self._node.get_name()]

    def _leave(self, name: str) -> None:
        if name in self._subscriptions:
            self._node.destroy_subscription(self._subscriptions.pop(name))
            del self._qos[name]


def message_class(type_name: str) -> type:
    """The class of `package/msg/Name`; UnknownType where the package is not installed."""
    package, _, name = type_name.split('/')
    try:
        return getattr(import_module(f'{package}.msg'), name)  # type: ignore[no-any-return]
    except (ModuleNotFoundError, AttributeError) as error:
        raise UnknownType(f'{type_name} is not installed here') from error


UPDATE_PERIOD = 0.25
"""Seconds between two searches for topics."""

DISCOVERY = 3.0
"""Seconds after which missing topics are logged: a name may be misspelt."""

PATIENCE = 60.0
"""Seconds without any message after which a recording without an end of its own gives up."""

FLUSH = 1.0
"""Seconds of messages that may be lost when the process is killed."""


@dataclass(frozen=True)
class Control:
    """How long a recording lasts, and its callbacks.

    until is a monotonic time, infinite for one that `interrupt` ends by raising Interrupted.
    on_listening is called once, when publishers and recorder have met; on_nobody once before,
    with topics and ROS domain, when DISCOVERY was not enough for it.
    """

    until: float
    interrupt: Callable[[], None]
    on_listening: Callable[[], None]
    on_nobody: Callable[[set[str], int], None]


def record(
    sink: Sink, namespace: str, selection: TopicSelection, control: Control
) -> tuple[set[str], int]:
    """Records to its end; where nothing is published and it has none, for PATIENCE.

    Returns every topic that was seen, selected or not, and the ROS domain. Raises NotWritten when
    the disk is full.
    """
    rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
    node = Node('recorder', namespace=namespace, enable_rosout=False)
    executor = EventsExecutor()
    executor.add_node(node)
    recorder, domain = Recorder(node, selection, sink), node.context.get_domain_id()
    try:
        with contextlib.suppress(Interrupted):
            _spin(executor, recorder, sink, control, domain)
    finally:
        executor.shutdown()
        node.destroy_node()
        try_shutdown()
    return recorder.there, domain


def _spin(
    executor: EventsExecutor, recorder: Recorder, sink: Sink, control: Control, domain: int
) -> None:
    begin = update_at = flush_at = met_at = time.monotonic()
    until = begin + PATIENCE if control.until == math.inf else control.until
    is_met, is_told, met = False, False, 0
    while (now := time.monotonic()) < until:
        control.interrupt()
        if now >= update_at:
            recorder.update(now)
            update_at = now + UPDATE_PERIOD
            if len(recorder.met) > met:
                met, met_at = len(recorder.met), now
            if not is_met and recorder.is_ready(every=now < met_at + DISCOVERY):
                is_met, until = True, control.until
                control.on_listening()
        if now >= begin + DISCOVERY and not is_told:
            recorder.warn() if is_met else control.on_nobody(recorder.there, domain)
            is_told = True
        if now >= flush_at:
            sink.flush()
            flush_at = now + FLUSH
        executor.spin_once(timeout_sec=min(0.05, max(until - now, 0.0)))
