"""A STOP from the bridge's own computer, by a datagram: at once, where DDS has to be found first.

A process that joins the graph computes a fifth of a second before its first message can go out;
on busy cores that is one or two. Who sends here has only to start. It can do nothing but stop.
"""

import contextlib
import os
import socket
from collections.abc import Callable

STOP = b'STOP'


def stop_address(bridge: str, domain: int) -> bytes:
    """Of the bridge with this full name ('/hexapod/serial_bridge') on this ROS domain.

    A name in the kernel, not on disk: it is gone when the bridge is.
    """
    return f'\0hexarm/{domain}{bridge}/stop'.encode()


def domain_here() -> int:
    """The ROS domain of this process, from the environment."""
    text = os.environ.get('ROS_DOMAIN_ID', '')
    return int(text) if text.isdecimal() else 0


def send_stop(address: bytes) -> bool:
    """Whether a bridge of this computer has it."""
    with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as sender:
        sender.setblocking(False)
        try:
            sender.sendto(STOP, address)
        except OSError:
            return False
    return True


class StopSocket:
    """Calls on_stop for each STOP that was sent to `address`; the link's thread waits for it.

    `problem`: why the address is not available, '' where it is; the other ways to stop remain.
    """

    def __init__(self, address: bytes, on_stop: Callable[[], object]) -> None:
        self.problem = ''
        self._on_stop = on_stop
        self._socket = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
        self._socket.setblocking(False)
        try:
            self._socket.bind(address)
        except OSError as error:
            self.problem = f'`hexarm stop` reaches this bridge over ROS only: {error.strerror}'

    def fileno(self) -> int:
        """For select."""
        return self._socket.fileno()

    def receive(self) -> None:
        """Takes one datagram, once the socket is readable."""
        with contextlib.suppress(BlockingIOError):
            if self._socket.recv(len(STOP)) == STOP:
                self._on_stop()

    def close(self) -> None:
        """Gives the address back."""
        self._socket.close()
