"""A stream of bytes cut into frames; what is damaged is counted, never raised."""

from bridge.frames import DELIMITER, MAX_WIRE_BYTES, Frame, Unreadable, decode
from manipulator.errors import ProtocolError


class FrameReader:
    """Feed it what arrived, get the frames that are complete. Holds at most one frame's bytes.

    bad_frames counts damaged frames, overruns those that were too long to be one. Whole
    frames that are no message of this protocol are passed over.
    """

    def __init__(self) -> None:
        self.bad_frames = 0
        self.overruns = 0
        self._pending = b''
        self._is_skipping = False

    def feed(self, received: bytes) -> list[Frame]:
        """The frames completed by `received`, oldest first."""
        *ended, self._pending = (self._pending + received).split(DELIMITER)
        frames = [frame for piece in ended if (frame := self._read(piece)) is not None]
        if len(self._pending) >= MAX_WIRE_BYTES:
            self._pending = b''
            self._is_skipping = True
        return frames

    def _read(self, stuffed: bytes) -> Frame | None:
        if self._is_skipping or len(stuffed) >= MAX_WIRE_BYTES:
            self._is_skipping = False
            self.overruns += 1
            return None
        if not stuffed:
            return None
        try:
            return decode(stuffed)
        except Unreadable:
            return None
        except ProtocolError:
            self.bad_frames += 1
            return None
