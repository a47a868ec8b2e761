"""The crank hexapod as a `Kinematics`: six crank angles, one pose."""

import math
from dataclasses import dataclass, field

import numpy as np

from hexapod_control.forward import XYZXY, ForwardByLengths
from hexapod_control.geometry import LEGS, RotaryGeometry
from hexapod_control.leg_closure import TURN, LegClosure
from hexapod_control.leg_jacobian import leg_jacobian, smallest_singular_value
from manipulator.arrays import Array, frozen
from manipulator.errors import ConfigError, InvalidInput, NoSolution, Unreachable
from manipulator.kinematics import ForwardSolution
from manipulator.pose import Pose

SINGULAR = 1e-6


@dataclass(frozen=True, eq=False)
class RotaryHexapod:
    """Kinematics of a crank platform; angles in radians from each leg's tangent towards up.

    characteristic_length (metres) scales rotations in σmin; a cold forward start is trusted
    where σmin is at least trusted_margin. Crank angles are given within half a turn of
    crank_centre. Construction raises ConfigError when the legs do not close at home.
    """

    geometry: RotaryGeometry
    characteristic_length: float
    trusted_margin: float
    crank_centre: float
    home: Pose = field(init=False)
    closure: LegClosure = field(init=False)
    newton: ForwardByLengths = field(init=False)
    home_side: float = field(init=False)
    tip_columns: tuple[Array, Array, Array] = field(init=False)

    def __post_init__(self) -> None:
        """Finds home and the sign of det J there."""
        g = self.geometry
        closure = LegClosure(g)
        home = Pose(np.array([0.0, 0.0, g.home_height]), np.eye(3))
        newton = ForwardByLengths(g.platform_points, self.characteristic_length)
        for name, value in (('home', home), ('closure', closure), ('newton', newton)):
            object.__setattr__(self, name, value)
        cranks = (g.crank_centres, _scaled(g, g.tangents), _scaled(g, g.ups))
        columns = tuple(frozen(points.T.take(XYZXY, axis=0)) for points in cranks)
        object.__setattr__(self, 'tip_columns', columns)
        try:
            joints = self.inverse(home)
        except Unreachable as error:
            raise ConfigError([f'the model does not close at home: {error}']) from error
        side = float(np.linalg.det(self.leg_jacobian(home, joints)))
        object.__setattr__(self, 'home_side', side)

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

    def forward(self, joints: Array, near: Pose | None = None) -> ForwardSolution:
        """The pose for crank angles (6,); see `Kinematics` and docs/kinematics.md, section 3.

        A start from home must end on home's side of every forward singularity, with σmin of at
        least trusted_margin; a start from `near` must end on near's side.
        """
        angles = np.asarray(joints, dtype=np.float64)
        if angles.shape != (LEGS,):
            raise NoSolution(f'joints have shape {angles.shape}, a pose needs ({LEGS},)')
        if not all(map(math.isfinite, angles.tolist())):
            raise NoSolution(f'joints are not finite: {angles.tolist()}')
        centres, along, up = self.tip_columns
        tips = centres + np.cos(angles) * along + np.sin(angles) * up
        lengths = self.geometry.rod_lengths
        if near is not None:
            return self.newton.solve_columns(tips, lengths, near, None, 0.0)
        solution = self.newton.solve_columns(
            tips, lengths, self.home, self.home_side, self.trusted_margin
        )
        if (self.tip_rates(solution.pose, angles) >= 0.0).any():
            raise NoSolution('the pose found bends a leg the other way than at home')
        return solution

    def crank_tips(self, joints: Array) -> Array:
        """Where crank meets rod, (..., 6, 3), base frame, metres."""
        g = self.geometry
        cosine, sine = np.cos(joints)[..., None], np.sin(joints)[..., None]
        turned = cosine * g.tangents + sine * g.ups
        tips: Array = g.crank_centres + g.crank_lengths[:, None] * turned
        return tips

    def unit_rods(self, pose: Pose, joints: Array) -> Array:
        """Unit vectors (..., 6, 3) from crank tip to platform joint, base axes."""
        rod = pose.transform(self.geometry.platform_points) - self.crank_tips(joints)
        unit: Array = rod / np.sqrt((rod * rod).sum(axis=-1))[..., None]
        return unit

    def leg_jacobian(self, pose: Pose, joints: Array) -> Array:
        """J (..., 6, 6): J·twist is how fast each rod would grow if its crank stood still, m/s."""
        return leg_jacobian(self.crank_tips(joints), self.geometry.platform_points, pose)

    def tip_rates(self, pose: Pose, joints: Array) -> Array:
        """uᵢ·∂bᵢ/∂qᵢ (..., 6) in m/rad: how fast each crank's tip moves along its rod.

        0 where crank and rod are in line: an inverse singularity, where the crank is powerless.
        """
        g = self.geometry
        cosine, sine = np.cos(joints)[..., None], np.sin(joints)[..., None]
        direction = cosine * g.ups - sine * g.tangents
        along = (self.unit_rods(pose, joints) * direction).sum(axis=-1)
        rates: Array = g.crank_lengths * along
        return rates

    def crank_leverage(self, pose: Pose, joints: Array) -> Array:
        """|tip rate| by crank length (..., 6), dimensionless: the inverse singularity's margin."""
        leverage: Array = np.abs(self.tip_rates(pose, joints)) / self.geometry.crank_lengths
        return leverage

    def crank_rates(self, pose: Pose, joints: Array) -> Array:
        """(..., 6, 6): crank rates of a unit twist; NoSolution where crank and rod are in line."""
        rates = self.tip_rates(pose, joints)
        if not (np.abs(rates) > SINGULAR * self.geometry.crank_lengths).all():
            raise NoSolution('inverse singularity: a crank and its rod are in line')
        result: Array = self.leg_jacobian(pose, joints) / rates[..., None]
        return result

    def jacobian(self, pose: Pose, joints: Array) -> Array:
        """(..., 6, 6): the twist of unit crank rates; NoSolution at a forward singularity."""
        rows = self.leg_jacobian(pose, joints)
        sigma = smallest_singular_value(rows, self.characteristic_length)
        if not (sigma > SINGULAR).all():
            raise NoSolution('forward singularity: the cranks do not fix the platform here')
        rates = self.tip_rates(pose, joints)
        return np.asarray(np.linalg.solve(rows, rates[..., None] * np.eye(LEGS)), dtype=np.float64)

    def sigma_min(self, pose: Pose, joints: Array) -> Array:
        """The forward singularity margin (...), dimensionless; NaN for NaN joints."""
        return smallest_singular_value(self.leg_jacobian(pose, joints), self.characteristic_length)

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
            f'leg {leg + 1}: rod too {"short" if short else "long"} by {1e3 * miss:.3g} mm '
            f'({1e3 * lengths[leg, 0]:.5g} mm, needs {1e3 * shortest[leg, column]:.5g} to '
            f'{1e3 * longest[leg, column]:.5g} mm)',
            int(leg) + 1,
        )


def _scaled(geometry: RotaryGeometry, directions: Array) -> Array:
    scaled: Array = geometry.crank_lengths[:, None] * directions
    return scaled


def _nearest(middle: Array, half: Array, near: Array) -> Array:
    """Of middle ± half, modulo whole turns, the angles nearest to `near`; elbow out on a tie."""
    out = np.remainder(middle + half - near + np.pi, TURN) - np.pi
    inside = np.remainder(middle - half - near + np.pi, TURN) - np.pi
    result: Array = near + np.where(np.abs(out) <= np.abs(inside), out, inside)
    return result
