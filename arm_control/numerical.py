"""Inverse of any chain by damped Newton steps from many starts (docs/arm-kinematics.md, 6).

A calibrated arm, built almost as one with a closed form, starts at that one's branches.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from arm_control.branches import without_repeats
from arm_control.chain import Chain
from arm_control.closed_forms import ParallelAxes, SphericalWrist
from arm_control.tracking import tracked_by_newton
from manipulator.arrays import Array, Mask
from manipulator.pose import Pose

STEPS = 60
STARTS = 32
TOLERANCE = 1e-10
LOOK_BACK, STALLED = 10, 0.9
"""A start whose error is still more than this part of what it was ten steps ago is given up."""

CHUNK = 256
"""Poses that are solved together: a few megabytes, a second, and Ctrl-C is heard."""


@dataclass(frozen=True, eq=False)
class Numerical:
    """Levenberg–Marquardt with the error as damping (Sugihara, IEEE T-RO 27(5), 2011).

    length scales metres against radians; low and high span the cold starts.
    """

    chain: Chain
    length: float
    low: Array
    high: Array

    @property
    def is_explicit(self) -> bool:
        """See `InverseMethod`."""
        return False

    def branches(self, pose: Pose, near: Array) -> Array:
        """What was found from `near` (entry 0) and from the cold starts: (..., 33, 6).

        A branch may be missed.
        """
        lead = pose.position.shape[:-1]
        places, turns = pose.position.reshape(-1, 3), pose.rotation.reshape(-1, 3, 3)
        wanted = np.broadcast_to(near, (*lead, 6)).reshape(-1, 6)
        found = np.full((len(places), STARTS + 1, 6), np.nan)
        near_enough = np.flatnonzero(self._is_within_reach(places))
        for some in np.split(near_enough, range(CHUNK, len(near_enough), CHUNK)):
            found[some] = self._solved(Pose(places[some], turns[some]), wanted[some])
        return found.reshape(*lead, STARTS + 1, 6)

    def _solved(self, pose: Pose, near: Array) -> Array:
        """The branches (n, 33, 6) of n poses."""
        spread = np.random.default_rng(0).uniform(self.low, self.high, (STARTS, 6))
        cold = np.broadcast_to(spread, (len(near), STARTS, 6))
        joints, error = self.descend(pose, np.concatenate([near[:, None], cold], axis=1))
        return without_repeats(np.where((error < TOLERANCE)[..., None], joints, np.nan))

    def along(self, poses: Pose, near: Array) -> Array:
        """See `InverseMethod`."""
        return tracked_by_newton(self.chain, poses, near, self.branches)

    def _is_within_reach(self, places: Array) -> Mask:
        """Whether the links, all in one line, come to the places (n, 3)."""
        path = np.vstack([self.chain.points, self.chain.home.position])
        reach = np.linalg.norm(np.diff(path, axis=0), axis=1).sum()
        away = np.linalg.norm(places - self.chain.points[0], axis=1)
        within: Mask = away <= reach * (1 + 1e-9)
        return within

    def refusal(self, pose: Pose) -> str:
        """How near the best attempt came."""
        middle = (self.low + self.high) / 2
        spread = np.random.default_rng(0).uniform(self.low, self.high, (STARTS, 6))
        joints, error = self.descend(pose, np.vstack([middle, spread]))
        miss = self.chain.forward(joints[np.argmin(error)]).twist_to(pose)
        distance, angle = np.linalg.norm(miss[:3]), np.degrees(np.linalg.norm(miss[3:]))
        return f'no joint angles found: the best of {STARTS + 1} starts missed by ' + (
            f'{distance:.4g} m and {angle:.3g}°'
        )

    def descend(self, pose: Pose, joints: Array, steps: int = STEPS) -> tuple[Array, Array]:
        """Joints (..., k, 6) after the steps, and the scaled error that is left of each."""
        lead = joints.shape[:-1]
        found = np.array(joints, dtype=np.float64).reshape(-1, 6)
        places = np.broadcast_to(pose.position[..., None, :], (*lead, 3)).reshape(-1, 3)
        turns = np.broadcast_to(pose.rotation[..., None, :, :], (*lead, 3, 3)).reshape(-1, 3, 3)
        going, left = np.arange(len(found)), np.empty(len(found))
        last = np.full(len(found), np.inf)
        for step in range(steps + 1):
            error = self._scale * self.chain.forward(found[going]).twist_to(
                Pose(places[going], turns[going])
            )
            size = np.linalg.norm(error, axis=-1)
            left[going] = size
            moving = size >= TOLERANCE / 10
            if step and step % LOOK_BACK == 0:
                moving &= size < STALLED * last[going]
            if step % LOOK_BACK == 0:
                last[going] = size
            going, error, size = going[moving], error[moving], size[moving]
            if step == steps or not going.size:
                break
            found[going] = self._stepped(found[going], error, size)
        return found.reshape(*lead, 6), left.reshape(lead)

    def _stepped(self, joints: Array, error: Array, size: Array) -> Array:
        """Joints (n, 6) after one damped step against their scaled errors (n, 6), sizes (n,)."""
        jacobian = self._scale[:, None] * self.chain.jacobian(joints)
        transposed = np.swapaxes(jacobian, -1, -2)
        damping = np.minimum(size**2 / 2, 0.1)[:, None, None] + 1e-12
        normal = transposed @ jacobian + damping * np.eye(6)
        stepped: Array = joints + np.linalg.solve(normal, transposed @ error[..., None])[..., 0]
        return stepped

    @property
    def _scale(self) -> Array:
        return np.array([1 / self.length] * 3 + [1.0] * 3)


ALMOST_PARALLEL, ALMOST_MEETING = np.radians(5.0), 0.005
"""How far axes may be from parallel (rad), and from meeting in one point (m)."""

ASIDE = (0.96, 1.04, 0.9)
"""Distances from the shoulder, as parts of the pose's own, at which the ideal arm is asked too."""

FEW_STEPS = 20
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
        joints, error = self.numerical.descend(pose, starts, FEW_STEPS)
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
