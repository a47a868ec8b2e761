"""The crank hexapod as a `Kinematics`: six crank angles, one pose."""

import math
from dataclasses import dataclass, field
from itertools import product

import numpy as np

from hexapod_control.forward import XYZXY
from hexapod_control.geometry import LEGS, RotaryGeometry
from hexapod_control.leg_closure import TURN, LegClosure
from hexapod_control.parallel_platform import ParallelPlatform
from manipulator.arrays import Array, frozen
from manipulator.errors import InvalidInput, Unreachable
from manipulator.formatting import length
from manipulator.pose import Pose
from manipulator.skeleton import Stroke, outline

BRANCHES_MEET = 0.1
"""Radians: so much nearer elbow in must be for a leg to be taken for bent that way."""


@dataclass(frozen=True, eq=False)
class RotaryHexapod(ParallelPlatform):
    """Kinematics of a crank platform; angles in radians from each leg's tangent towards up.

    Crank angles are given within half a turn of crank_centre. Construction as of
    `ParallelPlatform`.
    """

    geometry: RotaryGeometry
    crank_centre: float
    closure: LegClosure = field(init=False)
    tip_columns: tuple[Array, Array, Array] = field(init=False)

    def __post_init__(self) -> None:
        """Lays out the leg closure, and the circles of the crank tips for the forward solver."""
        g = self.geometry
        object.__setattr__(self, 'closure', LegClosure(g))
        cranks = (g.crank_centres, _scaled(g, g.tangents), _scaled(g, g.ups))
        columns = tuple(frozen(points.T.take(XYZXY, axis=0)) for points in cranks)
        object.__setattr__(self, 'tip_columns', columns)
        super().__post_init__()

    @property
    def joint_names(self) -> tuple[str, ...]:
        """crank_1 to crank_6."""
        return tuple(f'crank_{leg}' for leg in range(1, LEGS + 1))

    @property
    def joint_unit(self) -> str:
        """Radians."""
        return 'rad'

    def inverse(self, pose: Pose, near: Array | None = None) -> Array:
        """Crank angles (..., 6); see `Kinematics`. Elbow out unless `near` is nearer elbow in."""
        joints = self.inverse_or_nan(pose, near)
        if math.isnan(joints.sum()):
            self._explain(pose, near)
        return joints

    def inverse_or_nan(self, pose: Pose, near: Array | None = None) -> Array:
        """As `inverse`, with NaN for each crank whose leg does not close."""
        middle, half = self.closure.angles(pose)
        if near is None:
            angles = middle + half
            angles -= TURN * np.rint((angles - self.crank_centre) / TURN)
        else:
            wanted = np.asarray(near, dtype=np.float64)
            if wanted.ndim > 1:
                shape = (*pose.position.shape[:-1], LEGS)
                wanted = np.broadcast_to(wanted, shape).reshape(-1, LEGS)
            angles = _nearest(middle, half, wanted.reshape(-1, LEGS).T)
        return np.ascontiguousarray(angles.T).reshape(*pose.position.shape[:-1], LEGS)

    def inverse_all(self, pose: Pose) -> Array:
        """Every way to bend the legs (64, 6) for one pose, each elbow out or in; elbows out first.

        Within half a turn of crank_centre. Raises Unreachable where a leg does not close.
        """
        self.inverse(pose)
        middle, half = self.closure.angles(pose)
        signs = np.array(list(product((1.0, -1.0), repeat=LEGS)))
        angles: Array = middle[:, 0] + signs * half[:, 0]
        return angles - TURN * np.rint((angles - self.crank_centre) / TURN)

    def crank_tips(self, joints: Array) -> Array:
        """Where crank meets rod, (..., 6, 3), base frame, metres."""
        g = self.geometry
        cosine, sine = np.cos(joints)[..., None], np.sin(joints)[..., None]
        turned = cosine * g.tangents + sine * g.ups
        tips: Array = g.crank_centres + g.crank_lengths[:, None] * turned
        return tips

    def skeleton(self, pose: Pose, joints: Array) -> tuple[Stroke, ...]:
        """The crank axes' outline, six cranks, six rods, the platform's outline."""
        centres, tips = self.geometry.crank_centres, self.crank_tips(joints)
        cranks = (Stroke('crank', ends) for ends in np.stack([centres, tips], axis=1))
        _, *others = super().skeleton(pose, joints)
        return outline('body', centres), *cranks, *others

    def base_points(self, joints: Array) -> Array:
        """The crank tips."""
        return self.crank_tips(joints)

    def rod_lengths(self, joints: Array) -> Array:
        """The rods' own, whatever the angles: (6,)."""
        return self.geometry.rod_lengths

    def joint_gains(self, pose: Pose, joints: Array) -> Array:
        """uᵢ·∂bᵢ/∂qᵢ (..., 6) in m/rad: how fast each crank's tip moves along its rod.

        0 where crank and rod are in line: an inverse singularity, where the crank is powerless.
        """
        g = self.geometry
        cosine, sine = np.cos(joints)[..., None], np.sin(joints)[..., None]
        direction = cosine * g.ups - sine * g.tangents
        along = (self.unit_rods(pose, joints) * direction).sum(axis=-1)
        gains: Array = g.crank_lengths * along
        return gains

    def leverage(self, pose: Pose, joints: Array) -> Array:
        """|gain| by crank length (..., 6): the part of the tip's way that goes along the rod."""
        leverage: Array = np.abs(self.joint_gains(pose, joints)) / self.geometry.crank_lengths
        return leverage

    def _base_columns(self, joints: Array) -> Array:
        centres, along, up = self.tip_columns
        columns: Array = centres + np.cos(joints) * along + np.sin(joints) * up
        return columns

    def _explain(self, pose: Pose, near: Array | None) -> None:
        """Raises what made an angle NaN: an unusable `near`, or the leg that misses the most."""
        if near is not None and not np.isfinite(near).all():
            raise InvalidInput('the joints to stay near are not finite')
        shortest, longest = self.closure.rod_span(pose)
        lengths = self.geometry.rod_lengths[:, None]
        lack, surplus = shortest - lengths, lengths - longest
        leg, column = np.unravel_index(np.argmax(np.maximum(lack, surplus)), lack.shape)
        short = lack[leg, column] > surplus[leg, column]
        miss = lack[leg, column] if short else surplus[leg, column]
        raise Unreachable(
            f'leg {leg + 1}: rod too {"short" if short else "long"} by {length(miss, 3)} '
            f'({length(lengths[leg, 0], 5)}, needs {length(shortest[leg, column], 5)} to '
            f'{length(longest[leg, column], 5)})',
            int(leg) + 1,
        )


def _scaled(geometry: RotaryGeometry, directions: Array) -> Array:
    scaled: Array = geometry.crank_lengths[:, None] * directions
    return scaled


def _nearest(middle: Array, half: Array, near: Array) -> Array:
    """Of middle ± half, modulo whole turns, the angles nearest to `near`.

    Elbow out where neither is nearer by BRANCHES_MEET: at the edge of the reach both branches
    meet, and a machine that comes back from there bends its legs as it does at home.
    """
    out = np.remainder(middle + half - near + np.pi, TURN) - np.pi
    inside = np.remainder(middle - half - near + np.pi, TURN) - np.pi
    is_out = np.abs(out) <= np.abs(inside) + BRANCHES_MEET
    result: Array = near + np.where(is_out, out, inside)
    return result
