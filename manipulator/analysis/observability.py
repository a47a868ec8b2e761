"""Which combinations of parameters the measurements cannot distinguish, and which poses help.

The singular values of the slopes, per noise and tolerance, give their number. Each is first
looked for among the motions that one expects (a whole side of the machine, made up for by where
the device's pose); what is left is named by its largest terms.
"""

from dataclasses import dataclass

import numpy as np

from manipulator.analysis.device_frames import COUNT
from manipulator.analysis.measurements import Parameter
from manipulator.arrays import Array, Mask

UNSEEN = 1e-7
"""Of the largest singular value: numerically nothing."""

COMPENSATED = 1e-6
SMALL_TERM = 0.25
MOST_TERMS = 5


@dataclass(frozen=True)
class Sightlessness:
    """unseen: combinations that change nothing that was measured; vague: parameters of which the
    measurements determine less than the tolerance did.
    """

    unseen: tuple[str, ...]
    vague: tuple[str, ...]


def what_is_not_seen(
    slopes: Array,
    parameters: tuple[Parameter, ...],
    deviations: Array,
    rigid_motions: dict[str, Array],
) -> Sightlessness:
    """Slopes (m, p) per multiple of the noise, of the free parameters; deviations (p,) after.

    rigid_motions are directions (p,) of the model's parameters, zero where they are of frames.
    """
    scale = scales(parameters)
    _, sizes, directions = np.linalg.svd(slopes * scale, full_matrices=True)
    rank = int((sizes > UNSEEN * sizes[0]).sum())
    null = directions[rank:]
    named, null = _expected(slopes, parameters, rigid_motions, null)
    rest = tuple(_in_terms(row, parameters) for row in null)
    vague = tuple(
        p.name
        for p, deviation in zip(parameters, deviations, strict=True)
        if np.isfinite(p.tolerance) and deviation > 0.9 * p.tolerance
    )
    return Sightlessness(named + rest, vague)


def scales(parameters: tuple[Parameter, ...]) -> Array:
    """What makes values comparable: the tolerances, 10 mm and 0.1 rad where there are none."""
    usual = {'m': 0.01, 'rad': 0.1}
    return np.array(
        [p.tolerance if np.isfinite(p.tolerance) else usual[p.unit] for p in parameters]
    )


def _expected(
    slopes: Array,
    parameters: tuple[Parameter, ...],
    rigid_motions: dict[str, Array],
    null: Array,
) -> tuple[tuple[str, ...], Array]:
    """The names of rigid motions that frames make up for, and what they leave of `null`."""
    is_frame = np.array([p.group in ('device', 'marker') for p in parameters])
    if not is_frame.any() or not len(null):
        return (), null
    scale, named = scales(parameters), []
    for name, motion in rigid_motions.items():
        seen = slopes @ motion
        answer = -np.linalg.lstsq(slopes[:, is_frame], seen, rcond=None)[0]
        left = seen + slopes[:, is_frame] @ answer
        if not np.linalg.norm(left) <= COMPENSATED * np.linalg.norm(seen):
            continue
        whole = motion.copy()
        whole[is_frame] = answer
        direction = whole / scale
        frame = 'the device' if 'anchor' in name or 'the base' in name else 'the marker'
        null, is_new = _without(null, direction / np.linalg.norm(direction))
        if is_new:
            named.append(f'{name}, made up for by {frame}')
    return tuple(named), null


def _without(null: Array, direction: Array) -> tuple[Array, bool]:
    """An orthonormal basis of `null` less one direction in it, and whether it was in it."""
    parts = null @ direction
    if np.linalg.norm(parts) < 0.5:
        return null, False
    q, _ = np.linalg.qr(np.column_stack([parts, np.eye(len(parts))]))
    return q[:, 1 : len(parts)].T @ null, True


def _in_terms(row: Array, parameters: tuple[Parameter, ...]) -> str:
    """The largest terms of a direction, each as a part of its tolerance."""
    order = np.argsort(-np.abs(row))[:MOST_TERMS]
    biggest = row[order[0]]
    terms = [
        f'{row[i] / biggest:+.1f} {parameters[i].name}'
        for i in order
        if abs(row[i]) >= SMALL_TERM * abs(biggest)
    ]
    return ' '.join(terms)


def model_directions(motions: dict[str, Array], is_free: Mask) -> dict[str, Array]:
    """Rigid motions (model's parameters) as directions of all free parameters.

    A motion of which a part is not free is none.
    """
    found = {}
    for name, motion in motions.items():
        whole = np.concatenate([motion, np.zeros(COUNT)])
        if not whole[~is_free].any():
            found[name] = whole[is_free]
    return found


def most_telling(slopes: Array, scale: Array, count: int) -> list[int]:
    """Greedy D-optimal choice: each pose is the one that shrinks the covariance's volume most.

    slopes (n, 6, p) are in multiples of the noise; scale (p,) are the parameters' tolerances, by
    which their covariance begins. No pose is chosen twice.
    """
    rows = slopes * scale
    covariance = np.eye(rows.shape[2])
    spread = np.eye(6) + rows @ np.swapaxes(rows, 1, 2)  # 1 + H covariance Hᵀ of each pose
    left = np.ones(len(rows), dtype=np.bool_)
    chosen: list[int] = []
    for _ in range(min(count, len(rows))):
        gains = np.linalg.slogdet(spread)[1]
        best = int(np.argmax(np.where(left, gains, -np.inf)))
        common, inverse = covariance @ rows[best].T, np.linalg.inv(spread[best])
        shared = rows @ common
        spread = spread - shared @ inverse @ np.swapaxes(shared, 1, 2)
        covariance = covariance - common @ inverse @ common.T
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
