"""The kernel's functions (kernel/python.h): float64 arrays, C-contiguous, for one or N items."""

from manipulator.arrays import Array

def crank_inverse(
    legs: Array, position: Array, rotation: Array, near: Array | None, angles: Array
) -> int:
    """How many legs do not close; `angles` is written: see kernel/crank.h."""
