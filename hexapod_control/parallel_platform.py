"""What all parallel platforms share: six legs of one kind that end on one platform."""

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass, field
from itertools import product
from typing import ClassVar, Protocol

import numpy as np
from numpy import empty

from hexapod_control.forward import End, rules, solution
from hexapod_control.geometry import LEGS
from hexapod_control.leg_jacobian import (
    leg_jacobian,
    smallest_singular_value,
    units_and_jacobian,
)
from hexapod_control.legs import Legs
from hexapod_control.platform_limits import SHORTFALL, SURPLUS, VALUES, PlatformLimits
from manipulator import _kernel
from manipulator._kernel import leg_inverse
from manipulator.arrays import Array, Mask, frozen, stretched
from manipulator.errors import ConfigError, InvalidInput, NoSolution, Unreachable
from manipulator.formatting import length
from manipulator.kinematics import ForwardSolution, first_jump
from manipulator.links import PLATFORM, Link, Stroke, outline
from manipulator.pose import Pose

SINGULAR = 1e-6

ENDLESS = 1e6
"""Metres of a longest rod of which there is none: NEVER of kernel/legs.h is more."""

SAME = 0.02
"""Difference of joints (rad or m) that is a measurement's, not another branch's."""


class LegGeometry(Protocol):
    """Where the legs end on the platform, and where that is at home; metres."""

    @property
    def platform_points(self) -> Array:
        """Joint centres (6, 3) in the platform frame."""
        ...

    @property
    def home(self) -> Pose:
        """T_base_platform at home."""
        ...


@dataclass(frozen=True, eq=False)
class ParallelPlatform(ABC):
    """Six legs, each a straight rod from a base point to the platform: docs/kinematics.md.

    A kind of legs says where base points are and how long rods are for given joints: `_legs`. In
    J·twist = W·q̇, J is the leg Jacobian and W the diagonal of the joints' gains.
    characteristic_length (metres) scales rotations in σmin; a cold forward start is trusted
    where σmin is at least trusted_margin. Construction raises ConfigError when the legs do not
    close at home.
    """

    geometry: LegGeometry
    characteristic_length: float
    trusted_margin: float
    legs: Legs = field(init=False)
    parameters: Array = field(init=False)
    limits: PlatformLimits = field(init=False)
    home: Pose = field(init=False)
    warm: Array = field(init=False)
    cold: Array = field(init=False)
    home_side: float = field(init=False)
    home_bends: Array = field(init=False)
    powerless: ClassVar[str] = ''

    def __post_init__(self) -> None:
        """Finds home, the sign of det J there, and to which side each joint's gain is.

        parameters are the machine as the kernel takes it: platform of kernel/platform.h.
        """
        home = self.geometry.home
        self._put('home', home)
        self._lay_out(np.zeros((LEGS, 3)), np.zeros(LEGS))
        try:
            joints = self.inverse(home)
        except Unreachable as error:
            raise ConfigError([f'the model does not close at home: {error}']) from error
        gains = self.joint_gains(home, joints)
        self._lay_out(self.unit_rods(home, joints), gains)
        side = float(np.sign(np.linalg.det(self.leg_jacobian(home, joints))))
        self._put('home_side', side)
        self._put('home_bends', np.sign(gains))
        self._put('warm', rules(self.characteristic_length, None, 0.0))
        self._put('cold', rules(self.characteristic_length, side, self.trusted_margin))

    def _put(self, name: str, value: object) -> None:
        object.__setattr__(self, name, value)

    def _lay_out(self, home_rods: Array, home_gains: Array) -> None:
        legs, size = self._legs(), [self.characteristic_length]
        at_home = (home_rods.T.ravel(), home_gains, self.home.rotation.ravel())
        parameters = frozen(np.concatenate([legs.numbers, size, *at_home]))
        self._put('parameters', parameters)
        self._put('legs', legs)
        self._put('limits', PlatformLimits(parameters))

    @abstractmethod
    def _legs(self) -> Legs:
        """By `Legs.of`."""

    @property
    @abstractmethod
    def joint_names(self) -> tuple[str, ...]:
        """One name a leg."""

    @property
    @abstractmethod
    def joint_unit(self) -> str:
        """'rad' or 'm'."""

    @property
    def is_explicit(self) -> bool:
        """Each leg has its own closed form."""
        return True

    @property
    def joins_branches(self) -> bool:
        """A crank stays on its side of the rod."""
        return False

    def inverse(self, pose: Pose, near: Array | None = None) -> Array:
        """Joints (..., 6); see `Kinematics`. As bent at home unless `near` is nearer otherwise.

        It calls the kernel itself: of half a microsecond, each call of another function is a lot.
        """
        position = pose.position
        joints = empty(LEGS if position.ndim == 1 else (*position.shape[:-1], LEGS))
        if near is not None:
            near = stretched(near, joints.shape)
        if leg_inverse(self.legs.numbers, position, pose.rotation, near, joints):
            self._explain(pose, joints, near)
        return joints

    def inverse_or_nan(self, pose: Pose, near: Array | None = None) -> Array:
        """As `inverse`, with NaN for each joint whose leg does not close."""
        joints = np.empty((*pose.position.shape[:-1], LEGS))
        if near is not None:
            near = stretched(near, joints.shape)
        leg_inverse(self.legs.numbers, pose.position, pose.rotation, near, joints)
        return joints

    def inverse_all(self, pose: Pose) -> Array:
        """Every way to bend the legs (64, 6) for one pose, each in either; as at home first.

        Raises Unreachable where a leg does not close.
        """
        self.inverse(pose)
        is_as_home = np.array(list(product((True, False), repeat=LEGS)))
        return np.where(is_as_home, *self.legs.branches(pose))

    def _explain(self, pose: Pose, joints: Array, near: Array | None) -> None:
        """Raises what made a joint NaN: an unusable `near`, or the leg that misses the most."""
        if near is not None and not np.isfinite(near).all():
            raise InvalidInput('the joints to stay near are not finite')
        is_open = np.isnan(joints).any(axis=-1)
        values = self.limits.limited_values(pose[is_open], joints[is_open]).reshape(-1, VALUES)
        lack, surplus = values[:, SHORTFALL], values[:, SURPLUS]
        row, leg = np.unravel_index(np.argmax(np.maximum(lack, surplus)), lack.shape)
        rod, is_short = self.legs.rods[leg], lack[row, leg] > surplus[row, leg]
        miss, longest = max(lack[row, leg], surplus[row, leg]), rod - surplus[row, leg]
        most = 'or more' if longest > ENDLESS else f'to {length(longest, 5)}'
        raise Unreachable(
            f'leg {leg + 1}: rod too {"short" if is_short else "long"} by {length(miss, 3)} '
            f'({length(rod, 5)}, needs {length(rod + lack[row, leg], 5)} {most})',
            int(leg) + 1,
        )

    def inverse_along(self, poses: Pose, near: Array) -> Array:
        """See `Kinematics`: on home's branch where `near` is on it and all of it is continuous.

        Where two branches meet, as at a stretched crank, nearness alone cannot tell them apart.
        """
        as_home = self.inverse_or_nan(poses)
        if (np.abs(as_home[0] - near) < SAME).all() and first_jump(as_home) is None:
            return as_home
        joints = self.inverse_or_nan(poses, near)
        jump = first_jump(joints)
        if jump is not None:
            last = joints[jump]
            for i in range(jump + 1, len(joints)):
                joints[i] = self.inverse_or_nan(poses[i], last)
                last = joints[i] if np.isfinite(joints[i]).all() else last
        return joints

    def base_points(self, joints: Array) -> Array:
        """Where the rods begin, (..., 6, 3), base frame, metres; NaN for NaN joints."""
        return self.legs.base_points(joints)

    def rod_lengths(self, joints: Array) -> Array:
        """How long the rods are, (6,), metres: their own, whatever the joints."""
        return self.legs.rods

    def joint_gains(self, pose: Pose, joints: Array) -> Array:
        """Gains w (..., 6): how fast each rod's length follows its joint, m/rad or m/m.

        0 where the joint is powerless: an inverse singularity.
        """
        return self.legs.gains(joints, self.unit_rods(pose, joints))

    def leverage(self, pose: Pose, joints: Array) -> Array:
        """The inverse singularity's margin (..., 6), 0 to 1: |gain| by the most it can be."""
        return np.asarray(np.abs(self.joint_gains(pose, joints)) / self.legs.most_gains)

    def forward_along(self, joints: Array, near: Pose) -> Pose:
        """See `Kinematics`."""
        poses = []
        for row in joints:
            near = self.forward(row, near).pose
            poses.append(near)
        return Pose(np.array([p.position for p in poses]), np.array([p.rotation for p in poses]))

    def forward(self, joints: Array, near: Pose | None = None) -> ForwardSolution:
        """The pose for joints (6,); see `Kinematics` and docs/kinematics.md, section 3.

        A start from home must end on home's side of every forward singularity, with σmin of at
        least trusted_margin and no leg bent the other way; a start from `near` must end on near's
        side.
        """
        checked, margin = checked_joints(joints), self.trusted_margin if near is None else 0.0
        self.rod_lengths(checked)
        start, trusted = (self.home, self.cold) if near is None else (near, self.warm)
        position, rotation, report = np.empty(3), np.empty((3, 3)), np.empty(5)
        _kernel.platform_forward(
            self.parameters, trusted, checked, start.position, start.rotation,
            position, rotation, report,
        )  # fmt: skip
        return solution(position, rotation, report, margin)

    def forward_or_nan(self, joints: Array, near: Pose) -> Pose:
        """As `forward` for joints (..., 6), from `near` (...); NaN for no pose."""
        shape = np.broadcast_shapes(np.shape(joints)[:-1], near.position.shape[:-1])
        position, rotation = np.empty((*shape, 3)), np.empty((*shape, 3, 3))
        report = np.empty((*shape, 5))
        _kernel.platform_forward(
            self.parameters, self.warm, stretched(joints, (*shape, LEGS)),
            stretched(near.position, (*shape, 3)), stretched(near.rotation, (*shape, 3, 3)),
            position, rotation, report,
        )  # fmt: skip
        missed = report[..., 0] != End.FOUND
        position[missed], rotation[missed] = np.nan, np.nan
        return Pose.unchecked(position, rotation)

    def is_as_at_home(self, pose: Pose, joints: Array) -> Mask:
        """Which configurations (...) are on home's side of every singularity, of both types."""
        side = np.linalg.det(self.leg_jacobian(pose, joints)) * self.home_side > 0.0
        bends = self.joint_gains(pose, joints) * self.home_bends > 0.0
        result: Mask = side & bends.all(axis=-1)
        return result

    def unit_rods(self, pose: Pose, joints: Array) -> Array:
        """Unit vectors (..., 6, 3) along the rods, from base to platform, base axes."""
        points = self.geometry.platform_points
        return units_and_jacobian(self.base_points(joints), points, pose)[0]

    def leg_jacobian(self, pose: Pose, joints: Array) -> Array:
        """J (..., 6, 6): J·twist is how fast each rod would grow if its base point stood, m/s."""
        return leg_jacobian(self.base_points(joints), self.geometry.platform_points, pose)

    def joint_rates(self, pose: Pose, joints: Array) -> Array:
        """W⁻¹J (..., 6, 6): joint rates of a unit twist; NoSolution at an inverse singularity."""
        if not (self.leverage(pose, joints) > SINGULAR).all():
            raise NoSolution(f'inverse singularity: {self.powerless}')
        result: Array = self.leg_jacobian(pose, joints) / self.joint_gains(pose, joints)[..., None]
        return result

    def jacobian(self, pose: Pose, joints: Array) -> Array:
        """J⁻¹W (..., 6, 6): the twist of unit joint rates; NoSolution at a forward singularity."""
        rows = self.leg_jacobian(pose, joints)
        sigma = smallest_singular_value(rows, self.characteristic_length)
        if not (sigma > SINGULAR).all():
            raise NoSolution('forward singularity: the joints do not fix the platform here')
        gains = self.joint_gains(pose, joints)
        return np.asarray(np.linalg.solve(rows, gains[..., None] * np.eye(LEGS)))

    def skeleton(self, pose: Pose, joints: Array) -> tuple[Stroke, ...]:
        """The base points' outline, six rods, the platform's outline."""
        base, platform = self.base_points(joints), pose.transform(self.geometry.platform_points)
        rods = (Stroke('rod', ends) for ends in np.stack([base, platform], axis=1))
        return outline('body', base), *rods, outline('platform', platform)

    def links(self, pose: Pose, joints: Array) -> tuple[Link, ...]:
        """The platform alone: legs are lines, not frames."""
        return (Link(PLATFORM, pose),)

    def sigma_min(self, pose: Pose, joints: Array) -> Array:
        """The forward singularity margin (...), dimensionless; NaN for NaN joints."""
        return smallest_singular_value(self.leg_jacobian(pose, joints), self.characteristic_length)


def checked_joints(joints: Array) -> Array:
    """Six finite numbers; NoSolution for anything else."""
    checked = np.asarray(joints, dtype=np.float64)
    if checked.shape != (LEGS,):
        raise NoSolution(f'joints have shape {checked.shape}, a pose needs ({LEGS},)')
    if not all(map(math.isfinite, checked.tolist())):
        raise NoSolution(f'joints are not finite: {checked.tolist()}')
    return stretched(checked, (LEGS,))
