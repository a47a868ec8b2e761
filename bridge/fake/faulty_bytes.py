"""One direction of a bad line: bytes in; fewer, more, other, or later bytes out."""

from collections import deque
from collections.abc import Callable, Collection
from random import Random

from bridge.fake.faults import FaultKind

SHARE = 0.5
"""Of all pieces that pass while a fault lasts, how many it hits."""

LONGEST_DELAY, LONGEST_GAP = 0.3, 0.03
"""Seconds by which a delayed piece, and the second half of a split one, may come later."""


class FaultyBytes:
    """Bytes stay in order, and at most those of the last 0.3 s are delayed."""

    def __init__(self, seed: int = 0) -> None:
        self._random = Random(seed)
        self._on_their_way: deque[tuple[float, bytes]] = deque()

    def pass_on(self, piece: bytes, faults: Collection[FaultKind], now: float) -> bytes:
        """What comes out at `now` (s, monotonic) when `piece` goes in; b'' asks for the late."""
        for kind, damage in self._damages().items():
            if piece and kind in faults and self._random.random() < SHARE:
                piece = damage(piece)
        late = now
        if FaultKind.DELAY in faults and self._random.random() < SHARE:
            late = now + self._random.uniform(0.0, LONGEST_DELAY)
        cut = len(piece)
        if FaultKind.SPLIT in faults:
            cut = self._random.randint(0, len(piece))
        if piece:
            self._send(piece[:cut], late)
            self._send(piece[cut:], late + self._random.uniform(0.0, LONGEST_GAP))
        out = b''
        while self._on_their_way and self._on_their_way[0][0] <= now:
            out += self._on_their_way.popleft()[1]
        return out

    def _send(self, piece: bytes, at: float) -> None:
        if piece:
            ahead = self._on_their_way[-1][0] if self._on_their_way else at
            self._on_their_way.append((max(at, ahead), piece))

    def _damages(self) -> dict[FaultKind, Callable[[bytes], bytes]]:
        return {
            FaultKind.DROP: self._drop,
            FaultKind.DUPLICATE: self._duplicate,
            FaultKind.CORRUPT: self._corrupt,
        }

    def _slice(self, piece: bytes) -> tuple[int, int]:
        first = self._random.randrange(len(piece))
        return first, self._random.randint(first + 1, len(piece))

    def _drop(self, piece: bytes) -> bytes:
        first, end = self._slice(piece)
        return piece[:first] + piece[end:]

    def _duplicate(self, piece: bytes) -> bytes:
        first, end = self._slice(piece)
        return piece[:end] + piece[first:]

    def _corrupt(self, piece: bytes) -> bytes:
        at = self._random.randrange(len(piece))
        return piece[:at] + bytes([piece[at] ^ 1 << self._random.randrange(8)]) + piece[at + 1 :]
