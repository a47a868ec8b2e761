"""Down the distance to a target, within all limits: docs/workspace.md, section 2."""

import math
from dataclasses import dataclass

import numpy as np

from manipulator.analysis.free_paths import admits
from manipulator.analysis.readings import displaced, distance, offset, read_limits
from manipulator.analysis.slope import nearest_point, slopes
from manipulator.arrays import Array, Mask
from manipulator.machine import Machine
from manipulator.pose import Pose

CLEARANCE = 1e-6  # how far inside each limit an answer stays, by the characteristic length
WIDE = 30.0  # times that at first, since next to where a leg just closes slopes have no end
SETTLED = 1e-7  # a step that changes nothing, likewise
SHARES = 0.5 ** np.arange(10)
RESTORATIONS = 2
LEAST_CURVATURE = 0.2


@dataclass(frozen=True, eq=False)
class Linearised:
    """The limits about one pose: normals (m, 6)·step + slack (m,) ≥ 0, all in metres.

    goal (6,) is the step to the target. rows (2k,): which margins the m rows are.
    """

    pose: Pose
    goal: Array
    normals: Array
    slack: Array
    steepness: Array
    rows: Mask

    @classmethod
    def about(cls, machine: Machine, pose: Pose, target: Pose, clearance: float) -> 'Linearised':
        """By differences; margins that stand still or have no value are left out."""
        found = slopes(machine, pose)
        margins = found.readings.margins
        rows: Mask = (found.steepness > 0.0) & np.isfinite(margins)
        steepness = found.steepness[rows]
        slack = margins[rows] / steepness - clearance
        normals = found.gradients[rows] / steepness[:, None]
        return cls(pose, offset(machine, pose, target), normals, slack, steepness, rows)

    def step(self, curvature: Array) -> tuple[Array, Array]:
        """The best step within the limits, by a quadratic model (6, 6); multipliers (m,).

        These are NaN where there is none, or rounding has left the model no minimum.
        """
        try:
            root = np.linalg.cholesky(curvature)
        except np.linalg.LinAlgError:
            return self.goal, np.full(len(self.slack), np.nan)
        turned = np.linalg.solve(root, np.vstack([self.goal, self.normals]).T)
        step, weights = nearest_point(turned[:, 0], turned[:, 1:].T, self.slack)
        return np.linalg.solve(root.T, step), weights

    def lagrangian_slope(self, weights: Array, rows: Mask) -> Array:
        """The gradient (6,) of half the squared distance less the weighted limits `rows`."""
        full = np.zeros(len(rows))
        full[rows] = weights
        result: Array = -self.goal - full[self.rows] @ self.normals
        return result


@dataclass(frozen=True, eq=False)
class Descent:
    """Sequential quadratic programming, with the Lagrangian's curvature learnt by BFGS.

    clearance (m) is how far inside every limit its poses stay, to first order.
    """

    machine: Machine
    target: Pose
    clearance: float

    def run(self, start: Pose, most_steps: int) -> Pose:
        """From an admitted pose to ones nearer the target, until no step brings it nearer."""
        here, curvature, is_fresh = self._linearised(start), np.eye(6), True
        for _ in range(most_steps):
            step, weights = here.step(curvature)
            better = None if np.isnan(weights).any() else self._searched(here, step, weights)
            if better is None and is_fresh:
                break
            if better is None:
                curvature, is_fresh = np.eye(6), True
                continue
            there = self._linearised(better)
            taken = offset(self.machine, here.pose, better)
            before, after = (at.lagrangian_slope(weights, here.rows) for at in (here, there))
            curvature = damped_bfgs(curvature, taken, after - before)
            here, was_fresh, is_fresh = there, is_fresh, False
            if was_fresh and float(np.linalg.norm(taken)) < SETTLED * self._length:
                break
        return here.pose

    @property
    def _length(self) -> float:
        return self.machine.kinematics.characteristic_length

    def _linearised(self, pose: Pose) -> Linearised:
        return Linearised.about(self.machine, pose, self.target, self.clearance)

    def _searched(self, here: Linearised, step: Array, weights: Array) -> Pose | None:
        """The nearest admitted pose to the target among parts of the step, each put right."""
        trials = displaced(self.machine, here.pose, SHARES[:, None] * step)
        active = weights > 0.0
        if active.any():
            rows = np.flatnonzero(here.rows)[active]
            inverse = np.linalg.pinv(here.normals[active]).T
            for _ in range(RESTORATIONS):
                margins = read_limits(self.machine, trials).margins[:, rows]
                lack = self.clearance - margins / here.steepness[active]
                lack = np.fmax(lack, 0.0)  # NaN, of a leg that does not close, lacks nothing
                trials = displaced(self.machine, trials, lack @ inverse)
        inside = admits(self.machine, trials)
        distances = np.where(inside, distance(self.machine, trials, self.target), np.inf)
        best = int(np.argmin(distances))
        is_nearer = distances[best] < math.sqrt(here.goal @ here.goal) * (1.0 - 1e-12)
        return trials[best] if is_nearer else None


def descended(machine: Machine, target: Pose, start: Pose, most_steps: int) -> Pose:
    """An admitted pose at a local minimum of the distance, from the admitted `start`."""
    clearance = CLEARANCE * machine.kinematics.characteristic_length
    pose = Descent(machine, target, WIDE * clearance).run(start, most_steps)
    return Descent(machine, target, clearance).run(pose, most_steps)


def damped_bfgs(curvature: Array, step: Array, change: Array) -> Array:
    """Powell's damped update, which stays positive definite: Nocedal & Wright, (18.14)–(18.16)."""
    along = curvature @ step
    before, now = float(step @ along), float(step @ change)
    if now < LEAST_CURVATURE * before:
        share = (1.0 - LEAST_CURVATURE) * before / (before - now)
        change = share * change + (1.0 - share) * along
    result: Array = (
        curvature
        - np.outer(along, along) / before
        + np.outer(change, change) / float(step @ change)
    )
    return result
