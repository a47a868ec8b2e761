"""Running nodes as a process: clean start, clean stop, one line for what went wrong."""

import os
import signal
import sys
import threading
from collections.abc import Callable, Sequence
from types import FrameType

import rclpy
from rclpy.exceptions import ParameterException
from rclpy.experimental import EventsExecutor
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions
from rclpy.utilities import try_shutdown

from manipulator.errors import ManipulatorError
from manipulator.nodes.discovery import fresh_address
from manipulator.requirements import missing

GOODBYE = 3.0
"""Seconds that a node may take to leave the graph once it has closed what it holds."""


def run_nodes(
    makers: Sequence[Callable[[], Node]], describe: Callable[[str], str] | None = None
) -> int:
    """Spins nodes on one executor until SIGINT or SIGTERM; a start-up error is status 1.

    With `describe` the log begins with what that says of the first node's parameter `machine`.

    rclpy's own signal handlers would invalidate the context before the last message is out, so
    ours only set a flag. A node's `close()`, where it has one, runs before it is destroyed; the
    node made last is closed first.
    """
    stop = _StopRequest()
    rclpy.init(args=sys.argv, signal_handler_options=SignalHandlerOptions.NO)
    nodes: list[Node] = []
    try:
        with fresh_address():
            for make in makers:
                nodes.append(make())
    except (ManipulatorError, ParameterException, ModuleNotFoundError) as error:
        reason = missing(error) if isinstance(error, ModuleNotFoundError) else str(error)
        print(f'{sys.argv[0].rsplit("/", 1)[-1]}: {reason}', file=sys.stderr)
        _close(nodes)
        try_shutdown()
        return 1
    executor = EventsExecutor()
    for node in nodes:
        executor.add_node(node)
    try:
        if describe is not None:
            nodes[0].get_logger().info(describe(nodes[0].get_parameter('machine').value))
        while not stop.is_requested:
            executor.spin_once(timeout_sec=0.1)
    finally:
        _close(nodes)
        _leave_within(GOODBYE)
        executor.shutdown()
        for node in reversed(nodes):
            node.destroy_node()
        try_shutdown()
    _leave()
    return 0


def _close(nodes: Sequence[Node]) -> None:
    """Ends what nodes have begun, the last one's first."""
    for node in reversed(nodes):
        close = getattr(node, 'close', None)
        if close is not None:
            close()


def _leave_within(seconds: float) -> None:
    """Ends the process even where taking leave of the graph does not come back."""
    timer = threading.Timer(seconds, _leave)
    timer.daemon = True
    timer.start()


def _leave() -> None:
    """Ends the process here: the executor's own destructor now and then never comes back."""
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(0)


class _StopRequest:
    """Set by SIGINT and SIGTERM."""

    def __init__(self) -> None:
        self.is_requested = False
        signal.signal(signal.SIGINT, self._set)
        signal.signal(signal.SIGTERM, self._set)

    def _set(self, number: int, frame: FrameType | None) -> None:
        self.is_requested = True
