"""Consistent Overhead Byte Stuffing: any bytes without a zero, at most one byte in 254 longer.

Cheshire and Baker, "Consistent Overhead Byte Stuffing", IEEE/ACM Trans. Networking 7(2), 1999.
"""

from collections.abc import Iterator

from manipulator.errors import ProtocolError

LONGEST_RUN = 254


def encode(content: bytes) -> bytes:
    """`content` without zero bytes (and without the delimiter that ends a frame)."""
    return b''.join(bytes([len(run) + 1]) + run for run in _runs(content))


def decode(stuffed: bytes) -> bytes:
    """The content that `encode` stuffed; ProtocolError where a code points past the end."""
    content = bytearray()
    at, length = 0, len(stuffed)
    while at < length:
        code = stuffed[at]
        end = at + code
        if code == 0 or end > length:
            raise ProtocolError(f'COBS code {code} at byte {at} of {length}')
        content += stuffed[at + 1 : end]
        if code <= LONGEST_RUN and end < length:
            content.append(0)
        at = end
    return bytes(content)


def _runs(content: bytes) -> Iterator[bytes]:
    """The runs between zeros; a full run has no zero after it."""
    *before, last = content.split(b'\0')
    for piece in before:
        yield from _cut(piece)
        yield piece[len(piece) // LONGEST_RUN * LONGEST_RUN :]
    yield from _cut(last)
    if len(last) % LONGEST_RUN or not last:
        yield last[len(last) // LONGEST_RUN * LONGEST_RUN :]


def _cut(piece: bytes) -> Iterator[bytes]:
    """The full runs at the head of a stretch."""
    for start in range(0, len(piece) - LONGEST_RUN + 1, LONGEST_RUN):
        yield piece[start : start + LONGEST_RUN]
