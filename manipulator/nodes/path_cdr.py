"""nav_msgs/Path as it comes over the wire, read without ROS: what it is first, its poses later.

A message of a hundred megabytes must not be decoded to find out that it is too long, and two
thousand poses not in the command loop. Plain CDR (OMG DDS-XTypes 1.3, 7.4.1): four bytes that
tell the byte order, then values aligned to their size, strings with length and final zero.
"""

import struct
from dataclasses import dataclass

import numpy as np

from manipulator import rotation as so3
from manipulator.arrays import Array
from manipulator.errors import InvalidInput
from manipulator.pose import Pose
from manipulator.words import counted, shown

BYTE_ORDERS = {b'\0\0': '>', b'\0\1': '<'}
LONGEST_NAME = 256
SHORTEST_POSE = 68
"""Bytes of a pose without a frame_id."""

NUMBERS = ('x', 'y', 'z', 'qx', 'qy', 'qz', 'qw')


@dataclass(frozen=True)
class PathHead:
    """Stamp and frame of a path, how many poses follow, and where."""

    sec: int
    nanosec: int
    frame_id: str
    count: int
    offset: int


def read_head(serialized: bytes) -> PathHead:
    """The beginning of a path, in a time that does not depend on its length."""
    reader = _Reader(serialized)
    sec, nanosec = reader.numbers('iI')
    frame_id = reader.string()
    return PathHead(int(sec), int(nanosec), frame_id, int(reader.numbers('I')[0]), reader.offset)


def read_poses(serialized: bytes, frame: str) -> tuple[Pose, Array | None]:
    """Poses (n,) and their stamps (n,), in seconds from the first; None where all are equal.

    Raises InvalidInput, naming the pose, for numbers that are not finite, quaternions that are no
    rotation, frames that are neither empty nor `frame`, and stamps that do not all increase.
    """
    head = read_head(serialized)
    if not 0 < SHORTEST_POSE * head.count <= len(serialized):
        raise InvalidInput(f'{counted(head.count, "pose")} in {counted(len(serialized), "byte")}')
    reader = _Reader(serialized, head.offset)
    stamps, values = np.empty((head.count, 2), dtype=np.int64), np.empty((head.count, 7))
    for i in range(head.count):
        stamps[i] = reader.numbers('iI')
        name = reader.string()
        if name not in ('', frame):
            raise InvalidInput(
                f'pose {i + 1}: frame_id {shown(name)}, the path is in {shown(frame)}'
            )
        values[i] = reader.numbers('7d')
    return _poses(values), _seconds(stamps)


def _poses(values: Array) -> Pose:
    bad = np.argwhere(~np.isfinite(values))
    if len(bad):
        i, k = bad[0]
        raise InvalidInput(f'pose {i + 1}: {NUMBERS[k]} is {values[i, k]}, not a finite number')
    lengths = np.linalg.norm(values[:, 3:], axis=1)
    odd = np.flatnonzero(np.abs(lengths - 1.0) > so3.UNIT_TOLERANCE)
    if len(odd):
        i = odd[0]
        raise InvalidInput(
            f'pose {i + 1}: quaternion has length {lengths[i]:.6g}, a rotation needs 1 ± 0.001'
        )
    return Pose.from_xyz_quaternion(values[:, :3], values[:, 3:])


def _seconds(stamps: 'np.ndarray[tuple[int, ...], np.dtype[np.int64]]') -> Array | None:
    if (stamps == stamps[0]).all():
        return None
    since = stamps - stamps[0]
    seconds: Array = since[:, 0] + 1e-9 * since[:, 1]
    back = np.flatnonzero(np.diff(seconds) <= 0)
    if len(back):
        raise InvalidInput(
            f'pose {back[0] + 2}: its stamp is not after that of pose {back[0] + 1}: stamps must '
            'all increase, or all be the same'
        )
    return seconds


class _Reader:
    """Takes one value after the other; InvalidInput where the bytes end too early."""

    def __init__(self, serialized: bytes, offset: int = 4) -> None:
        if bytes(serialized[:2]) not in BYTE_ORDERS:
            raise InvalidInput('the path is not in plain CDR')
        self._order = BYTE_ORDERS[bytes(serialized[:2])]
        self._bytes = serialized
        self.offset = offset

    def numbers(self, kinds: str) -> tuple[float, ...]:
        """Numbers of one size, of `struct`'s kinds."""
        kind = struct.Struct(self._order + kinds)
        size = struct.calcsize(kinds[-1])
        begin = self.offset + -(self.offset - 4) % size
        try:
            found = kind.unpack_from(self._bytes, begin)
        except struct.error:
            raise InvalidInput('the path ends before its poses do') from None
        self.offset = begin + kind.size
        return found

    def string(self) -> str:
        """A short text."""
        length = int(self.numbers('I')[0])
        if length > LONGEST_NAME:
            raise InvalidInput(f'a frame_id of {length} characters')
        begin, self.offset = self.offset, self.offset + length
        return bytes(self._bytes[begin : self.offset]).rstrip(b'\0').decode(errors='replace')
