"""From six rod lengths to a pose: Newton's method on SE(3), docs/kinematics.md, section 3."""

import math
from enum import IntEnum

from manipulator.arrays import Array, frozen
from manipulator.errors import NoSolution
from manipulator.formatting import length
from manipulator.kinematics import ForwardSolution
from manipulator.pose import Pose


class End(IntEnum):
    """How Newton's method ended: `newton_end` of kernel/newton.h."""

    FOUND = 0
    SINGULAR = 1
    NOT_FOUND = 2
    BELOW_MARGIN = 3
    BEYOND = 4
    BENT = 5


def rules(characteristic_length: float, side: float | None, margin: float) -> Array:
    """What of a solution is trusted: `newton_rules` of kernel/newton.h."""
    return frozen([characteristic_length, math.nan if side is None else side, margin])


def solution(position: Array, rotation: Array, report: Array, margin: float) -> ForwardSolution:
    """What the kernel found; NoSolution where it found nothing, or nothing to be trusted."""
    end, iterations, miss, residual, sigma = report.tolist()
    if end != End.FOUND:
        raise NoSolution(_reason(End(int(end)), int(iterations), miss, sigma, margin))
    return ForwardSolution(Pose.unchecked(position, rotation), int(iterations), residual, sigma)


def _reason(end: End, iterations: int, miss: float, sigma: float, margin: float) -> str:
    if end == End.BELOW_MARGIN:
        return f'singularity margin {sigma:.3g} below {margin:.3g}: not trusted'
    if end == End.BEYOND:
        return 'the pose found lies beyond a singularity of the start'
    if end == End.BENT:
        return 'the pose found bends a leg the other way than at home'
    if end == End.SINGULAR:
        return 'forward kinematics met a singular pose'
    return (
        f'forward kinematics found no pose in {iterations} iterations: '
        f'the rods miss by {length(miss, 3)}'
    )
