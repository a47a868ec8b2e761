"""Running one node as a process: clean start, clean stop, one line for what went wrong."""

import faulthandler
import gc
import os
import signal
import sys
from collections.abc import Callable
from types import FrameType

import rclpy
from rclpy.exceptions import ParameterException
from rclpy.experimental import EventsExecutor
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions
from rclpy.utilities import try_shutdown

from manipulator.errors import ManipulatorError
from manipulator.requirements import missing

GOODBYE = 3.0
"""Seconds that a node may take to leave the graph once it has closed what it holds."""


def run_node(make_node: Callable[[], Node], describe: Callable[[str], str] | None = None) -> int:
    """Spins the node until SIGINT or SIGTERM; a start-up error is one line and exit status 1.

    With `describe` the node's log begins with what that says of its parameter `machine`.

    rclpy's own signal handlers would invalidate the context before the last message is out, so
    ours only set a flag. A node's `close()`, where it has one, runs before it is destroyed.
    """
    stop = _StopRequest()
    rclpy.init(args=sys.argv, signal_handler_options=SignalHandlerOptions.NO)
    try:
        node = make_node()
    except (ManipulatorError, ParameterException, ModuleNotFoundError) as error:
        said = missing(error) if isinstance(error, ModuleNotFoundError) else str(error)
        print(f'{sys.argv[0].rsplit("/", 1)[-1]}: {said}', file=sys.stderr)
        try_shutdown()
        return 1
    _keep_for_good()
    executor = EventsExecutor()
    executor.add_node(node)
    try:
        if describe is not None:
            node.get_logger().info(describe(node.get_parameter('machine').value))
        while not stop.is_requested:
            executor.spin_once(timeout_sec=0.1)
    finally:
        close = getattr(node, 'close', None)
        if close is not None:
            close()
        _leave_within(GOODBYE)
        executor.shutdown()
        node.destroy_node()
        try_shutdown()
    _leave()
    return 0


def run_named(*executables: Callable[[], int | None]) -> int | None:
    """`python -m ROOM NAME …`: runs the executable of that name; status 2 where there is none."""
    named = {run.__name__: run for run in executables}
    name = sys.argv[1] if len(sys.argv) > 1 else ''
    if name not in named:
        print(f'needs one of the names {", ".join(named)}', file=sys.stderr)
        return 2
    sys.argv[:2] = [name]
    return named[name]()


def _keep_for_good() -> None:
    """Leaves what is there now out of garbage collections, which kept ticks waiting for 30 ms."""
    gc.collect()
    gc.freeze()


def _leave_within(seconds: float) -> None:
    """Ends the process, with status 1, even where taking leave of the graph never comes back.

    While others leave too, Fast DDS 2.14 now and then waits for itself (`set_listener`), and rclpy
    keeps the interpreter's lock meanwhile: only a thread that is none of Python's gets a turn.
    """
    nowhere = os.open(os.devnull, os.O_WRONLY | os.O_CLOEXEC)
    faulthandler.dump_traceback_later(seconds, exit=True, file=nowhere)


def _leave() -> None:
    """Ends the process here: later the binding of ruckig would list leaks on the terminal."""
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
