"""An address of its own for a process that joins the graph, not that of one that has just died.

Fast DDS gives a process the lowest pair of UDP ports that is free. After a kill that is the dead
process's pair, while the others believe in the dead one for the 20 s of its lease: its heir goes
unheard, or hears nothing, for seconds. At another pair it mostly does not: docs/safety.md.
"""

import contextlib
import fcntl
import os
import random
import socket
import tempfile
from collections.abc import Iterator
from pathlib import Path

FIRST_PORT, PORTS_PER_DOMAIN, FIRST_OFFSET = 7400, 250, 10
"""Of unicast discovery: OMG DDSI-RTPS 2.5, section 9.6.2.3."""

ADDRESSES = 24
"""Taken in turn. On one computer alone processes find each other among the first 32."""


@contextlib.contextmanager
def fresh_address() -> Iterator[None]:
    """While it is open, the process's first node gets an address that was not in use lately.

    Holds the ports that come before; where that cannot be, the node gets one as usual.
    """
    with contextlib.ExitStack() as held:
        for address in range(_turn()):
            holder = held.enter_context(socket.socket(socket.AF_INET, socket.SOCK_DGRAM))
            with contextlib.suppress(OSError, OverflowError):
                holder.bind(('', _port(address)))
        yield


def _port(address: int) -> int:
    try:
        domain = int(os.environ.get('ROS_DOMAIN_ID', '0'))
    except ValueError:
        domain = 0  # rclpy will say what is wrong with it
    return FIRST_PORT + PORTS_PER_DOMAIN * domain + FIRST_OFFSET + 2 * address


def _turn() -> int:
    """The next of the addresses, counted over all processes of this user in a small file."""
    folder = Path(os.environ.get('XDG_RUNTIME_DIR') or tempfile.gettempdir())
    path = folder / f'hexarm-turn-{os.getuid()}'
    try:
        file = os.open(path, os.O_RDWR | os.O_CREAT | os.O_NOFOLLOW | os.O_CLOEXEC, 0o600)
    except OSError:
        return random.randrange(ADDRESSES)
    try:
        fcntl.flock(file, fcntl.LOCK_EX)
        last = os.pread(file, 1, 0) or b'\0'
        turn = (last[0] + 1) % ADDRESSES
        os.pwrite(file, bytes([turn]), 0)
        return turn
    except OSError:
        return random.randrange(ADDRESSES)
    finally:
        os.close(file)
