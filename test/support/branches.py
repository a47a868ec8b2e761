"""How far joints are from each other."""

import numpy as np


def apart(branches, joints):
    """The largest difference of a joint (last axis), whole turns aside; 9 for NaN, no branch."""
    gaps = np.abs(np.exp(1j * branches) - np.exp(1j * joints)).max(axis=-1)
    return np.nan_to_num(gaps, nan=9.0)
