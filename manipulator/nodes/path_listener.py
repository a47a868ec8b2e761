"""Hears `goal_path` in a process of its own, so that no message is too long for the command loop.

Receiving a hundred megabytes takes a process half a second, whatever it then does with them.
What is heard goes pickled to standard output, without its poses where they are too many; the
process ends with its standard input, that is with the node that started it.
"""

import os
import pickle
import signal
import sys
import threading
from dataclasses import dataclass

import rclpy
from nav_msgs.msg import Path
from rclpy.experimental import EventsExecutor
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions

from manipulator.errors import InvalidInput
from manipulator.nodes.discovery import fresh_address
from manipulator.nodes.path_cdr import PathHead, read_head
from manipulator.nodes.qos import COMMAND

MOST_POSES = 2000
MOST_BYTES = 1_000_000


@dataclass(frozen=True)
class HeardPath:
    """The beginning of a path, and all its bytes unless it is too long."""

    head: PathHead
    serialized: bytes


def heard(serialized: bytes) -> HeardPath | None:
    """What the command loop needs of a message; None where it is no path at all."""
    try:
        head = read_head(serialized)
    except InvalidInput:
        return None
    fits = head.count <= MOST_POSES and len(serialized) <= MOST_BYTES
    return HeardPath(head, bytes(serialized) if fits else b'')


class PathListener(Node):
    """One subscription, whose messages go to standard output."""

    def __init__(self, namespace: str, topic: str) -> None:
        super().__init__('path_listener', namespace=namespace)
        self.create_subscription(Path, topic, self._on_bytes, COMMAND, raw=True)

    def _on_bytes(self, serialized: bytes) -> None:
        message = heard(serialized)
        if message is not None:
            pickle.dump(message, sys.stdout.buffer)
            sys.stdout.buffer.flush()


def main() -> None:
    """Arguments: the node's namespace, the topic's full name."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=_end_with_parent, daemon=True).start()
    rclpy.init(args=[], signal_handler_options=SignalHandlerOptions.NO)
    executor = EventsExecutor()
    with fresh_address():
        node = PathListener(*sys.argv[1:3])
    executor.add_node(node)
    while True:
        executor.spin_once(timeout_sec=1.0)


def _end_with_parent() -> None:
    sys.stdin.buffer.read()
    os._exit(0)
