"""Array types and the one helper that freezes them."""

from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array: TypeAlias = NDArray[np.float64]
Mask: TypeAlias = NDArray[np.bool_]


def frozen(values: ArrayLike) -> Array:
    """A read-only float64 copy, safe to keep in a frozen dataclass."""
    array = np.array(values, dtype=np.float64)
    array.flags.writeable = False
    return array
