"""The recorder's node: looks around for topics, and writes what it hears until told to end."""

import contextlib
import math
import time
from collections.abc import Callable
from dataclasses import dataclass

import rclpy
from rclpy.experimental import EventsExecutor
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions
from rclpy.utilities import try_shutdown

from hexarm.cli.up import Interrupted
from hexarm.recording.bag import Bag
from hexarm.recording.listener import Listener
from hexarm.recording.wanted import Wanted

LOOK_AROUND = 0.25
"""Seconds between two looks at which topics there are."""

DISCOVERY = 3.0
"""Seconds after which what was not found is spoken of: a topic may be misspelt."""

PATIENCE = 60.0
"""Seconds after which a recording without an end of its own gives up, when nobody published."""

FLUSH = 1.0
"""Seconds of messages that may be lost when the process is killed."""


@dataclass(frozen=True)
class Control:
    """How long a recording lasts, and whom it tells how it stands.

    until is a monotonic time, infinite for one that `interrupt` ends by raising Interrupted.
    on_listening is called once, when publishers and recorder have met; on_nobody once before,
    with topics and ROS domain, when DISCOVERY was not enough for it.
    """

    until: float
    interrupt: Callable[[], None]
    on_listening: Callable[[], None]
    on_nobody: Callable[[set[str], int], None]


def record(bag: Bag, namespace: str, wanted: Wanted, control: Control) -> tuple[set[str], int]:
    """Records to its end; where nobody publishes and it has none, for PATIENCE.

    Returns every topic that was seen, wanted or not, and the ROS domain. Raises NotWritten when
    the disk is full.
    """
    rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
    node = Node('recorder', namespace=namespace, enable_rosout=False)
    executor = EventsExecutor()
    executor.add_node(node)
    listener, domain = Listener(node, wanted, bag), node.context.get_domain_id()
    try:
        with contextlib.suppress(Interrupted):
            _spin(executor, listener, bag, control, domain)
    finally:
        executor.shutdown()
        node.destroy_node()
        try_shutdown()
    return listener.there, domain


def _spin(
    executor: EventsExecutor, listener: Listener, bag: Bag, control: Control, domain: int
) -> None:
    begin = look_at = flush_at = time.monotonic()
    until = begin + PATIENCE if control.until == math.inf else control.until
    is_met = is_told = False
    while (now := time.monotonic()) < until:
        control.interrupt()
        if now >= look_at:
            listener.look_around(now)
            look_at = now + LOOK_AROUND
            if not is_met and listener.is_matched(every=now < begin + DISCOVERY):
                is_met, until = True, control.until
                control.on_listening()
        if now >= begin + DISCOVERY and not is_told:
            listener.warn() if is_met else control.on_nobody(listener.there, domain)
            is_told = True
        if now >= flush_at:
            bag.flush()
            flush_at = now + FLUSH
        executor.spin_once(timeout_sec=min(0.05, max(until - now, 0.0)))
