"""The recorder's node: looks around for topics, and writes what it hears until told to end."""

import contextlib
import time
from collections.abc import Callable

import rclpy
from rclpy.experimental import EventsExecutor
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions
from rclpy.utilities import try_shutdown

from hexarm.recording.bag import Bag
from hexarm.recording.listener import Listener
from hexarm.recording.wanted import Wanted
from hexarm.up import Interrupted
from manipulator.nodes.discovery import fresh_address

LOOK_AROUND = 0.25
"""Seconds between two looks at which topics there are."""

DISCOVERY = 3.0
"""Seconds after which a topic that was not found is spoken of: it may be misspelt."""

FLUSH = 1.0
"""Seconds of messages that may be lost when the process is killed."""


def record(
    bag: Bag, namespace: str, wanted: Wanted, until: float, interrupt: Callable[[], None]
) -> tuple[set[str], int]:
    """Records until the monotonic time `until`, or until `interrupt` raises Interrupted.

    Returns every topic that was seen, wanted or not, and the ROS domain. Raises NotWritten when
    the disk is full.
    """
    rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
    with fresh_address():
        node = Node('recorder', namespace=namespace, enable_rosout=False)
    executor = EventsExecutor()
    executor.add_node(node)
    listener, domain = Listener(node, wanted, bag), node.context.get_domain_id()
    try:
        with contextlib.suppress(Interrupted):
            _spin(executor, listener, bag, until, interrupt)
    finally:
        executor.shutdown()
        node.destroy_node()
        try_shutdown()
    return listener.there, domain


def _spin(
    executor: EventsExecutor,
    listener: Listener,
    bag: Bag,
    until: float,
    interrupt: Callable[[], None],
) -> None:
    look_at = flush_at = time.monotonic()
    warn_at = look_at + DISCOVERY
    while (now := time.monotonic()) < until:
        interrupt()
        if now >= look_at:
            listener.look_around(now)
            look_at = now + LOOK_AROUND
        if now >= warn_at:
            listener.warn()
            warn_at = until
        if now >= flush_at:
            bag.flush()
            flush_at = now + FLUSH
        executor.spin_once(timeout_sec=min(0.05, until - now))
