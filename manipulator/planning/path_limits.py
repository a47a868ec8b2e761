"""The speed along a path within a machine's limits: docs/motion.md, section 5.

With ' for d/ds, a joint moves at q'·ṡ and accelerates by q'·s̈ + q''·ṡ²; platform and tool alike.
On each interval between two nodes q'' is the mean, Δq'/Δs.

Fast timing of a path in the phase plane: two passes over squared path speeds.

On each interval of the path the acceleration is constant, so that the squares x and y of the
speed ṡ at its two ends fix it: s̈ = (y − x)/2Δ. Every limit is then a row A·x + B·y ≤ C, and one
of the two is eliminated: backwards the largest x from which y is not passed, forwards the largest
y. As in Pham, Pham 2018 (TOPP-RA, section VI), but no speed is allowed that could not be kept
(x = y): then one pass in each direction always succeeds. docs/motion.md, section 5.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from manipulator.arrays import Array
from manipulator.errors import NoSolution, Refused
from manipulator.kinematics import POSE_NUMBERS, chosen_rates
from manipulator.machine import Machine
from manipulator.motion_limits import SPEED_NAMES, Derivatives, JointDerivatives, MotionLimits
from manipulator.planning.check import first_fault
from manipulator.planning.path import Path


@dataclass(frozen=True, eq=False)
class Rows:
    """k rows for each of m intervals: A·x + B·y ≤ C, arrays (m, k), every C > 0."""

    on_begin: Array
    on_end: Array
    bound: Array

    @property
    def highest_kept(self) -> Array:
        """The largest square at which the path's speed can stay on each interval, (m,)."""
        kept = self.on_begin + self.on_end
        is_bound = kept > 0
        ratio = np.where(is_bound, self.bound / np.where(is_bound, kept, 1.0), np.inf)
        return np.asarray(ratio.min(axis=1))


def fastest(rows: Rows, highest: Array) -> Array:
    """Squared speeds (m + 1,) from rest to rest, nowhere above `highest` (m + 1,)."""
    kept = rows.highest_kept
    best = highest.copy()
    best[:-1] = np.minimum(best[:-1], kept)
    best[1:] = np.minimum(best[1:], kept)
    best[0] = best[-1] = 0.0
    cap, gain = _solved(rows.on_begin, rows.on_end, rows.bound)
    for i in range(len(best) - 2, 0, -1):
        best[i] = min(best[i], (cap[i] + gain[i] * best[i + 1]).min())
    cap, gain = _solved(rows.on_end, rows.on_begin, rows.bound)
    for i in range(len(best) - 2):
        best[i + 1] = min(best[i + 1], (cap[i] + gain[i] * best[i]).min())
    return np.asarray(best, dtype=np.float64)


def _solved(limited: Array, given: Array, bound: Array) -> tuple[Array, Array]:
    """Cap and gain: each limited square ≤ cap + gain·(the given one); ∞ and 0 where not bound.

    A row that bounds both from above only restricts what `highest_kept` already does.
    """
    is_bound = (limited > 0) & (given < 0)
    divisor = np.where(is_bound, limited, 1.0)
    cap = np.where(is_bound, bound / divisor, np.inf)
    return cap, np.where(is_bound, -given / divisor, 0.0)


DIRECTIONS = np.radians(np.arange(0.0, 181.0, 15.0))
"""In these the acceleration of platform or tool is bounded: a polygon within the circle."""


@dataclass(frozen=True, eq=False)
class PathLimits:
    """Bounds on ṡ² and its change at the nodes (m + 1,) of a path.

    highest (m + 1, j) bounds ṡ² by each speed limit, named by speed_names; rows has the
    acceleration limits of each interval, row_names their names. joints are those at the nodes.
    """

    nodes: Array
    joints: Array
    highest: Array
    speed_names: tuple[str, ...]
    rows: Rows
    row_names: tuple[str, ...]

    def most_at(self, square: float) -> tuple[float, str, float]:
        """The highest utilisation (see check.py) at ṡ² = square everywhere, its limit, and s."""
        speeds = np.sqrt(square / self.highest)
        demanded = square * (self.rows.on_begin + self.rows.on_end) / self.rows.bound
        rows = np.sqrt(np.maximum(demanded, 0.0))
        node, fastest = np.unravel_index(int(np.argmax(speeds)), speeds.shape)
        interval, hardest = np.unravel_index(int(np.argmax(rows)), rows.shape)
        if speeds[node, fastest] >= rows[interval, hardest]:
            name, s = self.speed_names[fastest], self.nodes[node]
            return float(speeds[node, fastest]), name, float(s)
        name, s = self.row_names[hardest], self.nodes[interval]
        return float(rows[interval, hardest]), name, float(s)


def path_limits(machine: Machine, path: Path, nodes: Array, near: Array) -> PathLimits:
    """The limits of the machine along a path, whose joints begin nearest to `near`.

    Raises Refused, saying where and why, for a path that leaves the machine's reach.
    """
    state = path.at(nodes)
    joints = machine.kinematics.inverse_along(state.pose, near)
    fault = first_fault(machine, machine.constraints, state.pose, joints)
    if fault is not None:
        node, reason = fault
        raise Refused(f'{path.where(float(nodes[node]))}: {reason}')
    twist, limits = state.twist, machine.motion.for_plans
    rates = _joint_rates(machine, path, nodes, joints, twist)
    names = machine.kinematics.joint_names
    bounded: tuple[_AxisLimit | _NormLimit, ...] = (
        _AxisLimit(rates, names, limits.joint),
        _NormLimit(twist[:, :3], 'linear', limits.linear),
        _NormLimit(twist[:, 3:], 'turning', limits.angular),
        *_axis_limits(twist, limits),
    )
    steps = np.diff(nodes)
    rows = [row for limit in bounded for row in limit.rows(steps)]
    bounds = Rows(*(np.concatenate([r[k] for r in rows], axis=1) for k in range(3)))
    return PathLimits(
        nodes,
        joints,
        np.concatenate([limit.highest for limit in bounded], axis=1),
        tuple(f'{name} speed' for limit in bounded for name in limit.speed_names),
        bounds,
        tuple(f'{name} acceleration' for limit in bounded for name in limit.row_names),
    )


def _joint_rates(machine: Machine, path: Path, nodes: Array, joints: Array, twist: Array) -> Array:
    """The joints' q' (m + 1, n) by the Jacobian; Refused where it is singular.

    Of a machine with more joints than a pose has numbers: of those that its inverse chooses.
    """
    pose = path.at(nodes).pose
    if joints.shape[-1] > POSE_NUMBERS:
        return _chosen(machine, path, nodes, joints, twist)
    try:
        jacobian = machine.kinematics.jacobian(pose, joints)
        return np.asarray(np.linalg.solve(jacobian, twist[..., None])[..., 0], dtype=np.float64)
    except (np.linalg.LinAlgError, NoSolution):
        worst = int(np.argmin(machine.kinematics.sigma_min(pose, joints)))
        raise Refused(f'{path.where(nodes[worst])}: the machine is singular there') from None


def _chosen(machine: Machine, path: Path, nodes: Array, joints: Array, twist: Array) -> Array:
    rates = chosen_rates(machine.kinematics, path.at(nodes).pose, joints, twist)
    lost = np.flatnonzero(~np.isfinite(rates).all(axis=-1))
    if len(lost):
        raise Refused(f'{path.where(float(nodes[lost[0]]))}: the end of the reach')
    return rates


def _axis_limits(twist: Array, limits: MotionLimits) -> Iterator['_AxisLimit']:
    """Of the axes of platform or tool whose speed is limited."""
    for k in np.flatnonzero(np.isfinite(limits.axis_speeds)).tolist():
        name = SPEED_NAMES[2 + k].removesuffix(' speed')
        limit = JointDerivatives.of(limits.axis_speeds[k], np.inf)
        yield _AxisLimit(twist[:, k : k + 1], (name,), limit)


@dataclass(frozen=True, eq=False)
class _AxisLimit:
    """Every component of `rates` (m + 1, n) bounded on its own."""

    rates: Array
    speed_names: tuple[str, ...]
    limit: JointDerivatives

    @property
    def highest(self) -> Array:
        return _squared_ratio(self.limit.speed, self.rates)

    @property
    def row_names(self) -> tuple[str, ...]:
        return 4 * self.speed_names

    def rows(self, steps: Array) -> Sequence[tuple[Array, Array, Array]]:
        bend = np.diff(self.rates, axis=0) / steps[:, None]
        found = []
        for rates, is_end in ((self.rates[:-1], False), (self.rates[1:], True)):
            on_begin, on_end = _row(rates, bend, steps, is_end)
            bound = np.broadcast_to(self.limit.acceleration, bend.shape)
            found += [(on_begin, on_end, bound), (-on_begin, -on_end, bound)]
        return found


@dataclass(frozen=True, eq=False)
class _NormLimit:
    """The length of the vectors `rates` (m + 1, 3) bounded."""

    rates: Array
    name: str
    limit: Derivatives

    @property
    def speed_names(self) -> tuple[str, ...]:
        return (self.name,)

    @property
    def row_names(self) -> tuple[str, ...]:
        return (self.name,) * (2 * len(DIRECTIONS))

    @property
    def highest(self) -> Array:
        lengths = np.linalg.norm(self.rates, axis=1)[:, None]
        return _squared_ratio(self.limit.speed, lengths)

    def rows(self, steps: Array) -> Sequence[tuple[Array, Array, Array]]:
        """In the plane of rate and bend: along the rate, and across it, where bend alone acts."""
        bend = np.diff(self.rates, axis=0) / steps[:, None]
        within = self.limit.acceleration * np.cos((DIRECTIONS[1] - DIRECTIONS[0]) / 2)
        found = []
        for rates, is_end in ((self.rates[:-1], False), (self.rates[1:], True)):
            length = np.linalg.norm(rates, axis=1)
            along = np.einsum('ij,ij->i', rates, bend) / np.maximum(length, 1e-12)
            squared = np.einsum('ij,ij->i', bend, bend) - along**2
            across = np.sqrt(np.maximum(squared, 0.0))[:, None]
            turned = along[:, None] * np.cos(DIRECTIONS) + across * np.sin(DIRECTIONS)
            forward = length[:, None] * np.cos(DIRECTIONS)
            on_begin, on_end = _row(forward, turned, steps, is_end)
            found.append((on_begin, on_end, np.full_like(turned, within)))
        return found


def _row(rate: Array, bend: Array, steps: Array, is_end: bool) -> tuple[Array, Array]:
    """rate·s̈ + bend·ṡ² as A·x + B·y, with ṡ² taken at the interval's begin or end."""
    pull = rate / (2 * steps[:, None])
    return (-pull, pull + bend) if is_end else (bend - pull, pull)


def _squared_ratio(speed: Array | float, rates: Array) -> Array:
    highest: Array = (speed / np.maximum(np.abs(rates), 1e-12)) ** 2
    return highest
