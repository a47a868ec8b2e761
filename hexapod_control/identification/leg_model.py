"""Six legs whose parameters are to be found: what cranks and linear legs have in common.

Leg i closes where |R b + p − c| − d = 0, with the rod's ends c (base frame) and b (platform
frame) and its length d. So J·twist = −∂gap/∂parameter, J the leg Jacobian: each parameter acts on
its own leg alone. docs/calibration.md, section 4.
"""

from abc import ABC, abstractmethod
from dataclasses import dataclass

import numpy as np

from hexapod_control.geometry import LEGS, RotaryGeometry
from hexapod_control.leg_jacobian import leg_jacobian
from hexapod_control.linear_geometry import LinearGeometry
from hexapod_control.rails import RailGeometry
from manipulator.analysis.measurements import Parameter
from manipulator.arrays import Array
from manipulator.errors import NoSolution
from manipulator.pose import Pose

MOST_ITERATIONS = 20
CLOSED = 1e-12


@dataclass(frozen=True)
class Tolerances:
    """How well a machine was built, as standard deviations: lengths in m, angles in rad."""

    length: float
    angle: float


@dataclass(frozen=True, eq=False)
class Legs:
    """The legs at n poses: base ends c (n, 6, 3), platform ends (6, 3), lengths (n, 6)."""

    base: Array
    platform: Array
    lengths: Array


class LegModel(ABC):
    """A `Model` of a platform; a kind of legs says what its parameters do to the gaps."""

    @property
    @abstractmethod
    def parameters(self) -> tuple[Parameter, ...]:
        """Six a kind and leg, or eighteen for points: leg by leg, then x, y, z."""

    @abstractmethod
    def identified(self, values: Array) -> RotaryGeometry | LinearGeometry | RailGeometry:
        """The geometry with these values."""

    @abstractmethod
    def legs(self, values: Array, joints: Array) -> Legs:
        """The legs of the machine with these values."""

    @abstractmethod
    def gap_slopes(self, values: Array, joints: Array, units: Array, arms: Array) -> Array:
        """(n, 6, p): how each leg's gap grows by each parameter.

        units (n, 6, 3) are along the rods towards the platform, base axes; arms the same in
        platform axes.
        """

    def screw_turns(self, values: Array, poses: Pose) -> tuple[Array | float, Array | float]:
        """What joints are longer than legs at n poses, (n, 6), and its rows (n, 6, 6): 0."""
        return 0.0, 0.0

    def predict(self, values: Array, joints: Array, near: Pose) -> Pose:
        """By Newton's method, all poses at once; see `Model`."""
        legs, pose = self.legs(values, joints), near
        for _ in range(MOST_ITERATIONS):
            rods = pose.transform(legs.platform) - legs.base
            extra, turning = self.screw_turns(values, pose)
            missing = legs.lengths - extra - np.sqrt((rods * rods).sum(axis=-1))
            if not np.isfinite(missing).all():
                break
            if np.abs(missing).max() < CLOSED:
                return pose
            rows = leg_jacobian(legs.base, legs.platform, pose) + turning
            try:
                pose = pose.moved(np.linalg.solve(rows, missing[..., None])[..., 0])
            except np.linalg.LinAlgError:
                break
        raise NoSolution(
            'the legs do not close with these parameters: is the CSV of this machine?'
        )

    def slopes(self, values: Array, joints: Array, poses: Pose) -> Array:
        """See `Model`."""
        legs = self.legs(values, joints)
        rods = poses.transform(legs.platform) - legs.base
        units = rods / np.sqrt((rods * rods).sum(axis=-1))[..., None]
        gaps = self.gap_slopes(values, joints, units, units @ poses.rotation)
        rows = leg_jacobian(legs.base, legs.platform, poses)
        rows = rows + self.screw_turns(values, poses)[1]
        return np.asarray(np.linalg.solve(rows, -gaps))


def points_parameters(name: str, group: str, tolerance: float) -> tuple[Parameter, ...]:
    """Three coordinates a leg."""
    return tuple(
        Parameter(f'{name} {leg} {axis}', group, 'm', tolerance)
        for leg in range(1, LEGS + 1)
        for axis in 'xyz'
    )


def leg_parameters(text: str, group: str, unit: str, tolerance: float) -> tuple[Parameter, ...]:
    """One a leg; text has {} where the leg's number goes."""
    return tuple(Parameter(text.format(leg), group, unit, tolerance) for leg in range(1, LEGS + 1))


def own_leg(values: Array) -> Array:
    """(n, 6, 6·k) of (n, 6, k): what belongs to a leg acts on that leg alone."""
    count, _, width = values.shape
    spread = np.zeros((count, LEGS, LEGS, width))
    legs = np.arange(LEGS)
    spread[:, legs, legs] = values
    return spread.reshape(count, LEGS, LEGS * width)


ANCHORS, JOINTS = slice(0, 18), slice(18, 36)
"""Of the parameters of every kind of leg."""


def rigid_motions_of(anchors: Array, joints: Array, count: int) -> dict[str, Array]:
    """Directions (count,) of all anchors (6, 3), or all platform joints, moved as one body."""
    found = {}
    base = _rigid_point_motions(anchors, 'the anchors')
    platform = _rigid_point_motions(joints, 'the platform joints')
    for part, motions in ((ANCHORS, base), (JOINTS, platform)):
        for motion, direction in motions.items():
            found[motion] = np.zeros(count)
            found[motion][part] = direction
    return found


def turned_with_the_anchors(frames: Array) -> dict[str, Array]:
    """Turns (3, 6) about each leg's three axes, columns of frames (6, 3, 3), by rigid motion."""
    whole = {}
    for axis, direction in zip('xyz', np.eye(3), strict=True):
        turns = np.linalg.solve(frames, np.broadcast_to(direction[:, None], (LEGS, 3, 1)))
        whole[f'the anchors turned together about {axis}'] = turns[..., 0].T
    return whole


def _rigid_point_motions(points: Array, name: str) -> dict[str, Array]:
    """Directions (18,) of six points that move as one body: three shifts and three turns."""
    shifts = {
        f'{name} shifted together along {axis}': np.tile(direction, LEGS)
        for axis, direction in zip('xyz', np.eye(3), strict=True)
    }
    turns = {
        f'{name} turned together about {axis}': np.cross(direction, points).ravel()
        for axis, direction in zip('xyz', np.eye(3), strict=True)
    }
    return shifts | turns
