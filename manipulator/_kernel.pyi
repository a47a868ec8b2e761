"""The kernel's functions (kernel/python.h): float64 arrays, C-contiguous, for one or N items."""

from manipulator.arrays import Array

def crank_inverse(
    legs: Array, position: Array, rotation: Array, near: Array | None, angles: Array
) -> int:
    """How many legs do not close; `angles` is written: see kernel/crank.h."""

def chain_forward(chain: Array, joints: Array, position: Array, rotation: Array) -> int:
    """How many poses are not finite; both are written: see kernel/chain.h."""

def chain_displacements(chain: Array, joints: Array, moved: Array) -> int:
    """Writes seven 4 × 4 matrices an item."""

def chain_jacobian(chain: Array, joints: Array, jacobian: Array) -> int:
    """Writes it."""
