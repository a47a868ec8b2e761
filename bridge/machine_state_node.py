"""The part of serial_bridge that says `machine_state`: at every change, and over and over.

A listener can tell by it that the bridge lives.
"""

import threading
from collections.abc import Mapping

from diagnostic_msgs.msg import DiagnosticStatus
from rclpy.node import Node

from bridge.machine_status import MachineStatus
from manipulator.nodes.diagnostics import ERROR, OK, WARN, status
from manipulator.nodes.qos import LATCHED
from manipulator.nodes.steady_timer import SteadyTimer

LEVELS = (OK, WARN, ERROR)
PERIOD = 0.5
"""Seconds between two times; who needs the state gives up after three (trajectory/pilot.py)."""


class StateTopic:
    """Publishes the state of the machine; from any thread."""

    def __init__(self, node: Node) -> None:
        self._node = node
        self._publisher = node.create_publisher(DiagnosticStatus, 'machine_state', LATCHED)
        self._said: tuple[MachineStatus, Mapping[str, object]] | None = None
        self._message: DiagnosticStatus | None = None
        self._lock = threading.Lock()
        self._timer = SteadyTimer(node, PERIOD, self._say_again)

    def say(self, current: MachineStatus, values: Mapping[str, object]) -> None:
        """Publishes the state and its values where they have changed."""
        with self._lock:
            if (current, values) == self._said:
                return
            if self._said is None or self._said[0] != current:
                reason = f' ({current.reason})' if current.reason else ''
                self._node.get_logger().info(f'machine {current.word}{reason}')
            self._said = current, values
            name = f'{self._node.get_name()}: machine state'
            self._message = status(LEVELS[current.level], name, current.word, values)
            self._publisher.publish(self._message)

    def _say_again(self) -> None:
        # Under the lock, or an older state could be said after a newer one.
        with self._lock:
            if self._message is not None:
                self._publisher.publish(self._message)
