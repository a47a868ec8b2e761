"""Plans of joints over time; curves through points, as joint_trajectory_controller makes them.

The curves are pieces of polynomials: between two points with velocities a cubic, with
accelerations as well a quintic. Points of positions alone are joined by lines; parabolas round
their corners.
"""

from dataclasses import dataclass

import numpy as np

from manipulator.arrays import Array, Mask, frozen
from manipulator.kinematics import Kinematics
from manipulator.planning.plan import CoordinateCurve, Ends, MotionState, Plan
from manipulator.pose import Pose

TERMS = 6
"""Coefficients of a piece: at most a quintic."""

ORDERS = np.arange(TERMS)

DIFFERENCE_STEP = 1e-4
"""s, for the change of the Jacobian."""


@dataclass(frozen=True, eq=False)
class JointCurvePlan(Plan):
    """The joints' curve, and the poses (k,) at equal steps of its time."""

    kinematics: Kinematics
    curve: CoordinateCurve
    knots: Pose

    @property
    def duration(self) -> float:
        """Seconds from rest to rest."""
        return self.curve.duration

    def joints_at(self, times: Array | float) -> Array:
        """See `Plan`."""
        return self.curve.at(times)[0]

    def at(self, times: Array | float) -> MotionState:
        """The state at each of the times (...): poses by forward kinematics, twists by Jacobian.

        Raises NoSolution where the joints fix no pose.
        """
        shape, flat = np.shape(times), np.ravel(times)
        q, rates, pulls = self.curve.at(flat)
        poses = self.kinematics.forward_along(q, self.knots[self._knot(float(flat[0]))])
        jacobian = self.kinematics.jacobian(poses, q)
        twist = _times(jacobian, rates)
        h = DIFFERENCE_STEP
        ahead = self.kinematics.jacobian(poses.moved(h * twist), q + h * rates)
        behind = self.kinematics.jacobian(poses.moved(-h * twist), q - h * rates)
        bend = _times(ahead - behind, rates) / (2 * h)
        acceleration = _times(jacobian, pulls) + bend
        pose = Pose(poses.position.reshape(*shape, 3), poses.rotation.reshape(*shape, 3, 3))
        return MotionState(pose, twist.reshape(*shape, 6), acceleration.reshape(*shape, 6))

    def _knot(self, time: float) -> int:
        last = len(self.knots.position) - 1
        return min(max(round(time / max(self.duration, 1e-9) * last), 0), last)


def _times(jacobian: Array, rates: Array) -> Array:
    result: Array = np.einsum('...ij,...j->...i', jacobian, rates)
    return result


@dataclass(frozen=True, eq=False)
class Curve:
    """On piece i, which begins at breaks[i], q = Σ coefficients[i, k]·τᵏ.

    breaks (p + 1,) in s from 0; coefficients (p, TERMS, n).
    """

    breaks: Array
    coefficients: Array

    @property
    def duration(self) -> float:
        """Seconds."""
        return float(self.breaks[-1])

    def at(self, times: Array | float) -> Ends:
        """q, q̇ and q̈ (..., n) at each of the times (...), those of the ends before and after."""
        t = np.clip(np.asarray(times, dtype=np.float64), 0.0, self.duration)
        last = len(self.breaks) - 2
        piece = np.clip(np.searchsorted(self.breaks, t, side='right') - 1, 0, last)
        into, c = (t - self.breaks[piece])[..., None], self.coefficients[piece]
        powers = into**ORDERS
        slopes = ORDERS * into ** np.maximum(ORDERS - 1, 0)
        bends = ORDERS * (ORDERS - 1) * into ** np.maximum(ORDERS - 2, 0)
        q, rate, pull = (np.einsum('...k,...kn->...n', p, c) for p in (powers, slopes, bends))
        return q, rate, pull


def splines(times: Array, positions: Array, velocities: Array, accelerations: Array) -> Curve:
    """Through m points: times (m,), the others (m, n); accelerations of NaN are not given."""
    steps = np.diff(times)[:, None]
    change = np.diff(positions, axis=0)
    v0, v1 = velocities[:-1], velocities[1:]
    a0, a1 = accelerations[:-1], accelerations[1:]
    cubic = [
        positions[:-1], v0,
        (3 * change / steps - 2 * v0 - v1) / steps,
        (-2 * change / steps + v0 + v1) / steps**2,
        0 * change, 0 * change,
    ]  # fmt: skip
    quintics = quintic((positions[:-1], v0, a0), (positions[1:], v1, a1), steps)
    has_both: Mask = np.isfinite(np.concatenate([a0, a1], axis=1)).all(axis=1)
    rows = np.where(has_both[:, None, None], np.stack(quintics, axis=1), np.stack(cubic, axis=1))
    return Curve(frozen(times - times[0]), frozen(rows))


def quintic(start: Ends, end: Ends, seconds: Array | float) -> list[Array]:
    """The six coefficients (..., n) of polynomials from one end to another, the constant first."""
    (x, v, a), (x_end, v_end, a_end) = start, end
    left = x_end - (x + seconds * (v + seconds * a / 2.0))
    faster = (v_end - (v + seconds * a)) * seconds
    harder = (a_end - a) * seconds**2
    return [
        x,
        v,
        a / 2.0,
        (10.0 * left - 4.0 * faster + harder / 2.0) / seconds**3,
        (-15.0 * left + 7.0 * faster - harder) / seconds**4,
        (6.0 * left - 3.0 * faster + harder / 2.0) / seconds**5,
    ]


def rounded_lines(times: Array, positions: Array, widths: Array) -> Curve:
    """Along lines through m points: times (m,), positions (m, n); from rest to rest.

    widths (m,): half of the time of each corner's parabola, at most half of the lines beside it.
    It begins widths[0] before the first time and ends widths[-1] after the last.
    """
    steps = np.diff(times)
    still = np.zeros((1, positions.shape[1]))
    rates = np.concatenate([still, np.diff(positions, axis=0) / steps[:, None], still])
    before, after = rates[:-1], rates[1:]
    w = widths[:, None]
    corners = [positions - w * before, before, (after - before) / (4 * w)]
    lines = [positions + w * after, after, 0 * after]
    count, joints = positions.shape
    rows = np.zeros((2 * count, TERMS, joints))
    rows[0::2, :3], rows[1::2, :3] = np.stack(corners, axis=1), np.stack(lines, axis=1)
    breaks = np.stack([times - widths, times + widths], axis=1).ravel()
    return Curve(frozen(breaks - breaks[0]), frozen(rows[:-1]))


def narrowest(times: Array, positions: Array, accelerations: Array, least: float) -> Array:
    """Half of the time (m,) that each corner needs at these accelerations (n,), at least `least`.

    At most half of the shorter line beside it.
    """
    steps = np.diff(times)
    still = np.zeros((1, positions.shape[1]))
    rates = np.concatenate([still, np.diff(positions, axis=0) / steps[:, None], still])
    needed = (np.abs(np.diff(rates, axis=0)) / (2 * accelerations)).max(axis=1)
    widths: Array = np.minimum(np.maximum(needed, least), widest(times))
    return widths


def widest(times: Array) -> Array:
    """Half of the shorter line beside each point (m,)."""
    steps = np.diff(times)
    result: Array = 0.5 * np.minimum(np.append(steps[0], steps), np.append(steps, steps[-1]))
    return result
