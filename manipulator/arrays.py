"""Array types, and how values become arrays that may be kept or handed to the kernel."""

from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array: TypeAlias = NDArray[np.float64]
Mask: TypeAlias = NDArray[np.bool_]


def frozen(values: ArrayLike) -> Array:
    """A read-only float64 copy, C-contiguous, safe to keep in a frozen dataclass."""
    array = np.array(values, dtype=np.float64, order='C')
    array.flags.writeable = False
    return array


def adjacent(values: ArrayLike) -> Array:
    """float64 values, C-contiguous and aligned as the kernel needs them: copied if not so."""
    array = np.asarray(values, dtype=np.float64)
    flags = array.flags
    return array if flags.c_contiguous and flags.aligned else array.copy(order='C')


def stretched(values: ArrayLike, shape: tuple[int, ...]) -> Array:
    """As `adjacent`, broadcast to a shape."""
    array = np.asarray(values, dtype=np.float64)
    return adjacent(array if array.shape == shape else np.broadcast_to(array, shape))
