"""A STOP from the bridge's own computer, by a datagram: at once, where DDS has to be found first.

A process that joins the graph computes a fifth of a second before its first message can go out;
on busy cores that is one or two. Who sends here has only to start. It can do nothing but stop.
"""

import os
import socket
import threading
from collections.abc import Callable

STOP = b'STOP'


def stop_address(bridge: str, domain: int) -> bytes:
    """Of the bridge with this full name ('/hexapod/serial_bridge') on this ROS domain.

    A name in the kernel, not on disk: it is gone when the bridge is.
    """
    return f'\0hexarm/{domain}{bridge}/stop'.encode()


def domain_here() -> int:
    """The ROS domain of this process, without asking ROS."""
    words = os.environ.get('ROS_DOMAIN_ID', '')
    return int(words) if words.isdecimal() else 0


def send_stop(address: bytes) -> bool:
    """Whether a bridge of this computer has it."""
    with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as sender:
        sender.setblocking(False)
        try:
            sender.sendto(STOP, address)
        except OSError:
            return False
    return True


class StopSocket(threading.Thread):
    """Calls on_stop, in this thread, for each STOP that was sent to `address`.

    Where the address is taken on_trouble hears why, and the other ways to stop remain.
    """

    def __init__(
        self, address: bytes, on_stop: Callable[[], object], on_trouble: Callable[[str], object]
    ) -> None:
        super().__init__(name='stop socket', daemon=True)
        self._address, self._on_stop, self._on_trouble = address, on_stop, on_trouble
        self._is_closing = False
        self._socket = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)

    def run(self) -> None:
        """The thread's work, until `close`."""
        try:
            self._socket.bind(self._address)
        except OSError as error:
            self._on_trouble(f'`hexarm stop` is not heard but over ROS: {error.strerror}')
            return
        while not self._is_closing:
            if self._socket.recv(len(STOP)) == STOP:
                self._on_stop()

    def close(self) -> None:
        """Ends the thread."""
        self._is_closing = True
        self._socket.shutdown(socket.SHUT_RD)
        self.join()
        self._socket.close()
