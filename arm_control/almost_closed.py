"""Inverse of arms that were built almost as one with a closed form: a calibrated arm's."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from arm_control.branches import without_repeats
from arm_control.chain import Chain
from arm_control.numerical import TOLERANCE, Numerical
from arm_control.parallel_axes import ParallelAxes
from arm_control.spherical_wrist import SphericalWrist
from arm_control.tracking import tracked_by_newton
from manipulator.arrays import Array
from manipulator.pose import Pose

ALMOST_PARALLEL, ALMOST_MEETING = np.radians(5.0), 0.005
"""How far axes may be from parallel (rad), and from meeting in one point (m)."""

ASIDE = (0.96, 1.04, 0.9)
"""Distances from the shoulder, as parts of the pose's own, at which the ideal arm is asked too."""

STEPS = 20
"""Of descent from the ideal arm's branches: more is only needed where two branches meet."""


@dataclass(frozen=True, eq=False)
class AlmostClosed:
    """What damped Newton steps find from `near` and from the eight branches of the ideal arm."""

    ideal: SphericalWrist | ParallelAxes
    numerical: Numerical

    @property
    def is_explicit(self) -> bool:
        """See `InverseMethod`."""
        return False

    def branches(self, pose: Pose, near: Array) -> Array:
        """All eight and NaN (..., 9, 6); for one pose that has none, what `Numerical` finds."""
        starts = self._starts(pose, near)
        joints, error = self.numerical.descend(pose, starts, STEPS)
        found = without_repeats(np.where((error < TOLERANCE)[..., None], joints, np.nan))
        if pose.position.ndim == 1 and np.isnan(found).all():
            return self.numerical.branches(pose, near)
        return found

    def _starts(self, pose: Pose, near: Array) -> Array:
        """`near`, then the ideal arm's branches, or where it has none those a little aside.

        At the edge of the reach the real arm may have a branch which the ideal one has not.
        """
        starts = self.ideal.branches(pose, near)
        shoulder = self.ideal.chain.points[1]
        for stretch in ASIDE:
            lost = np.isnan(starts)
            if not lost.any():
                break
            place = shoulder + stretch * (pose.position - shoulder)
            starts = np.where(lost, self.ideal.branches(Pose(place, pose.rotation), near), starts)
        first = np.broadcast_to(near[..., None, :], (*starts.shape[:-2], 1, starts.shape[-1]))
        return np.concatenate([first, np.where(np.isnan(starts), first, starts)], axis=-2)

    def along(self, poses: Pose, near: Array) -> Array:
        """See `InverseMethod`."""
        return tracked_by_newton(self.numerical.chain, poses, near, self.branches)

    def refusal(self, pose: Pose) -> str:
        """Which triangle of the ideal arm does not close, or how near the real one comes."""
        is_out_of_reach = np.isnan(self.ideal.branches(pose, np.zeros(6))).all()
        return (self.ideal if is_out_of_reach else self.numerical).refusal(pose)


def idealised(chain: Chain) -> Iterator[Chain]:
    """The chain with axes made parallel, and made to meet, where they almost are and do."""
    axes, points = chain.axes, chain.points
    for parallel, meeting in (((1, 2), (3, 4, 5)), ((1, 2, 3), (4, 5))):
        common, centre = _common(axes[list(parallel)]), _nearest(axes, points, meeting)
        if common is None or centre is None:
            continue
        directions, places = axes.copy(), points.copy()
        directions[list(parallel)] = np.sign(axes[list(parallel)] @ common)[:, None] * common
        places[list(meeting)] = centre
        yield Chain(directions, places, chain.home)


def _common(axes: Array) -> Array | None:
    """The mean direction (3,) of axes that are almost parallel, whichever way they point."""
    signs = np.sign(axes @ axes[0])
    total: Array = (signs[:, None] * axes).sum(axis=0)
    mean: Array = total / np.linalg.norm(total)
    sines = np.linalg.norm(np.cross(axes, mean), axis=1)
    return mean if sines.max() < np.sin(ALMOST_PARALLEL) else None


def _nearest(axes: Array, points: Array, which: Sequence[int]) -> Array | None:
    """The point (3,) nearest to some axes; None where they pass it too far away."""
    chosen, through = axes[list(which)], points[list(which)]
    across = np.eye(3) - chosen[:, :, None] * chosen[:, None, :]
    offsets = np.einsum('nij,nj->ni', across, through)
    point: Array = np.linalg.lstsq(across.reshape(-1, 3), offsets.ravel(), rcond=None)[0]
    missed = np.linalg.norm(np.einsum('nij,nj->ni', across, point - through), axis=1)
    return point if missed.max() < ALMOST_MEETING else None
