"""Which poses to measure: of many, the few that tell most about the parameters."""

import numpy as np

from manipulator.arrays import Array


def most_telling(slopes: Array, scale: Array, count: int) -> list[int]:
    """Greedy D-optimal choice: each pose is the one that shrinks the covariance's volume most.

    slopes (n, 6, p) are in multiples of the noise; scale (p,) are the parameters' tolerances, by
    which their covariance begins. No pose is chosen twice.
    """
    rows = slopes * scale
    covariance = np.eye(rows.shape[2])
    left = np.ones(len(rows), dtype=np.bool_)
    chosen: list[int] = []
    for _ in range(min(count, len(rows))):
        spread = rows @ covariance @ np.swapaxes(rows, 1, 2)
        gains = np.linalg.slogdet(np.eye(6) + spread)[1]
        best = int(np.argmax(np.where(left, gains, -np.inf)))
        H = rows[best]
        gain = covariance @ H.T @ np.linalg.inv(np.eye(6) + H @ covariance @ H.T)
        covariance = covariance - gain @ H @ covariance
        left[best] = False
        chosen.append(best)
    return chosen


def in_driving_order(twists: Array) -> list[int]:
    """Each pose after its nearest neighbour; twists (n, 6) from home, rotations as lengths."""
    left, here, order = set(range(len(twists))), np.zeros(6), []
    while left:
        nearest = min(left, key=lambda i: float(np.linalg.norm(twists[i] - here)))
        left.remove(nearest)
        order.append(nearest)
        here = twists[nearest]
    return order
