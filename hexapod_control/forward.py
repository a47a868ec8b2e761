"""From six rod lengths to a pose: Newton's method on SE(3), docs/kinematics.md, section 3."""

import math
from dataclasses import dataclass
from enum import IntEnum

import numpy as np

from manipulator import _kernel
from manipulator.arrays import Array, frozen, stretched
from manipulator.errors import InvalidInput, NoSolution
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


@dataclass(frozen=True, eq=False)
class ForwardByLengths:
    """The pose at which six rods of given lengths join base points and platform points.

    platform_points (6, 3) are in the platform frame, in metres; characteristic_length (metres)
    scales rotations in σmin. A crank platform is one of these, too, with the crank tips as base
    points.
    """

    platform_points: Array
    characteristic_length: float

    def __post_init__(self) -> None:
        """Checks the shape; raises InvalidInput."""
        points = frozen(self.platform_points)
        if points.shape != (6, 3):
            raise InvalidInput(f'platform points have shape {points.shape}, need (6, 3)')
        object.__setattr__(self, 'platform_points', points)

    def solve(
        self,
        base_points: Array,
        lengths: Array,
        start: Pose,
        side: float | None = None,
        margin: float = 0.0,
    ) -> ForwardSolution:
        """Newton from `start`; base_points (6, 3) and lengths (6,) in metres.

        side is the sign that det J must have, by default that at `start`; margin the least σmin.
        Raises NoSolution when nothing is found, or what is found lies beyond a singularity.
        """
        position, rotation, report = np.empty(3), np.empty((3, 3)), np.empty(5)
        _kernel.forward_by_lengths(
            self.platform_points,
            rules(self.characteristic_length, side, margin),
            stretched(base_points, (6, 3)),
            stretched(lengths, (6,)),
            start.position,
            start.rotation,
            position,
            rotation,
            report,
        )
        return solution(position, rotation, report, margin)


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
