"""Running nodes in a process: clean start, clean stop, one line for what went wrong."""

import faulthandler
import gc
import os
import signal
import sys
import threading
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager

import rclpy
from rclpy.exceptions import ParameterException
from rclpy.experimental import EventsExecutor
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions
from rclpy.utilities import try_shutdown

from manipulator.errors import ManipulatorError
from manipulator.nodes.stop_signal import StopSignal
from manipulator.requirements import missing

GOODBYE = 3.0
"""Seconds that nodes may take to leave the graph once they have closed what they hold."""

Makers = Sequence[Callable[[], Node]]


def run_nodes(makers: Makers, describe: Callable[[str], str] | None = None) -> int:
    """Spins nodes on one executor until SIGINT or SIGTERM; a start-up error is status 1.

    With `describe` the log begins with its text for the first node's parameter `machine`.

    rclpy's own signal handlers would invalidate the context before the last message is out, so
    ours only set a flag.
    """
    stop = StopSignal((signal.SIGINT, signal.SIGTERM))
    rclpy.init(args=sys.argv, signal_handler_options=SignalHandlerOptions.NO)
    try:
        with on_executor(makers) as (nodes, executor):
            if describe is not None:
                nodes[0].get_logger().info(describe(nodes[0].get_parameter('machine').value))
            while not stop.is_set:
                executor.spin_once(timeout_sec=0.1)
    except (ManipulatorError, ParameterException, ModuleNotFoundError) as error:
        reason = missing(error) if isinstance(error, ModuleNotFoundError) else str(error)
        print(f'{sys.argv[0].rsplit("/", 1)[-1]}: {reason}', file=sys.stderr)
        try_shutdown()
        return 1
    with leaving_within(GOODBYE):
        try_shutdown()
    return 0


@contextmanager
def context(arguments: Sequence[str]) -> Iterator[None]:
    """The context of ROS of this process, with these arguments for all its nodes."""
    rclpy.init(args=list(arguments), signal_handler_options=SignalHandlerOptions.NO)
    try:
        yield
    finally:
        try_shutdown()


@contextmanager
def spinning(makers: Makers) -> Iterator[Callable[[], bool]]:
    """Nodes in a thread of this process, in an existing context; knows whether it still runs.

    An exception in a callback ends the thread, after its traceback.
    """
    is_over = threading.Event()
    with on_executor(makers) as (_, executor):

        def spin() -> None:
            while not is_over.is_set():
                executor.spin_once(timeout_sec=0.1)

        thread = threading.Thread(target=spin, name='nodes')
        thread.start()
        try:
            yield thread.is_alive
        finally:
            is_over.set()
            thread.join()


@contextmanager
def on_executor(makers: Makers) -> Iterator[tuple[list[Node], EventsExecutor]]:
    """Nodes, made in this order, and their executor.

    At the end a node's `close()`, where it has one, runs before it is destroyed; the node made
    last is closed first.
    """
    nodes: list[Node] = []
    executor = None
    try:
        for make in makers:
            nodes.append(make())
        _keep_for_good()
        executor = EventsExecutor()
        for node in nodes:
            executor.add_node(node)
        yield nodes, executor
    finally:
        for node in reversed(nodes):
            close = getattr(node, 'close', None)
            if close is not None:
                close()
        with leaving_within(GOODBYE):
            if executor is not None:
                executor.shutdown()
            for node in reversed(nodes):
                node.destroy_node()


def _keep_for_good() -> None:
    """Leaves what is there now out of garbage collections, which kept ticks waiting for 30 ms."""
    gc.collect()
    gc.freeze()


@contextmanager
def leaving_within(seconds: float) -> Iterator[None]:
    """Ends the process, with status 1, where taking leave of the graph never comes back.

    While others leave too, Fast DDS 2.14 now and then waits for itself (`set_listener`), and rclpy
    keeps the interpreter's lock meanwhile: only a thread that is none of Python's gets a turn.
    """
    with open(os.devnull, 'w', encoding='utf-8') as nowhere:
        faulthandler.dump_traceback_later(seconds, exit=True, file=nowhere)
        yield
        faulthandler.cancel_dump_traceback_later()
