"""Our inverses of the UR5, on the problems of the other libraries."""

from bench.peers.arm_library import our_rows
from bench.row import Row


def rows() -> list[Row]:
    return our_rows()
