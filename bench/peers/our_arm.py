"""Our UR5's inverses, on the problems that the other libraries get."""

from bench.peers.arm_library import our_rows
from bench.row import Row


def rows() -> list[Row]:
    return our_rows()
