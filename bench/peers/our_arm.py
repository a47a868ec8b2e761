"""Our UR5 on the problems that the arm libraries get."""

from bench.peers.arm_library import ours
from bench.row import Row


def rows() -> list[Row]:
    return ours()
