"""Goals out of reach, replaced by the nearest pose within all limits, at the rate of a stream.

From the last answer and from where the machine is: two local minima, of which the nearer one
counts. Platforms descend in the kernel, over poses; arms here, over joints: docs/motion.md, 6.1.
"""

from dataclasses import replace

import numpy as np

from manipulator.analysis.free_paths import admits, line_between
from manipulator.analysis.readings import displaced, distance, offset, scale
from manipulator.analysis.slope import nearest_point, slopes
from manipulator.arrays import Array
from manipulator.errors import Unreachable
from manipulator.limits.limit import Search
from manipulator.machine import Machine
from manipulator.planning.goal import Goal
from manipulator.planning.planner import check_goal, refuse_absurd
from manipulator.pose import Pose

CLEARANCE = 1e-3
"""Of the characteristic length: how far inside the limits it stays, as lines between two such
poses do not bend with the limits."""

SPARE = 1e-5
"""rad, m or a ratio that a line keeps inside the limits, as it is looked at in steps."""

MOST_STEPS = 30
LEAST_SIGMA = 0.1
"""σmin of an arm that goes as far as it reaches: it can still be driven there."""

MOST_SLIDES, SLIDES = 8, 0.5 ** np.arange(6)
"""Steps along what parts meet, each of the largest of these parts that is admitted."""

ARM_JOINTS = 6
"""As many as the kernel's search has variables: other machines' goals stay as they are."""

LONGEST_STEP = 0.3
"""rad of any joint."""

DIFFERENCE, SETTLED = 1e-7, 1e-6
LEAST_DAMPED, EASED, DAMPED, MOST_DAMPED = 1e-9, 0.25, 8.0, 1e3
PARTS = (0.5, 0.25, 0.125, 0.06, 0.03)
"""Of the line to the nearest pose, for poses on the way along curved limits."""


class NearestGoal:
    """One machine's; changes with each goal."""

    def __init__(self, machine: Machine) -> None:
        self._machine = machine
        self._last: tuple[Pose, Array] | None = None

    def reached(self, goal: Goal, pose: Pose, joints: Array) -> Goal:
        """The goal, or the nearest that can be reached; the machine is at `pose`, `joints` (n,).

        Raises Refused for a goal that is farther away than any machine is large.
        """
        refuse_absurd(self._machine, goal.pose)
        if not self._machine.constraints.is_one_group and len(joints) != ARM_JOINTS:
            return goal
        try:
            check_goal(self._machine, goal.pose, joints)
        except Unreachable as error:
            reason = str(error)
        else:
            self._last = None
            return goal
        starts = [(pose, joints), *filter(None, [self._last])]
        if not self._machine.kinematics.is_explicit:
            starts = starts[-1:]  # one search takes as long as a stream leaves time for
        found = [self._descended(goal.pose, *start) for start in starts]
        nearest = min(found, key=lambda one: float(distance(self._machine, one[0], goal.pose)))
        self._last = nearest
        note = _words(nearest[0], goal.pose, reason)
        end = self._with_free_line(pose, joints, nearest[0])
        return replace(goal, pose=end, note=note, then=None if end is nearest[0] else goal)

    def _with_free_line(self, pose: Pose, joints: Array, nearest: Pose) -> Pose:
        """The nearest pose, or where the line to it is not free, one on the way along the limits.

        It is nearest to a part of that line; the goal is then pursued from there.
        """
        if self._is_free(pose, joints, nearest):
            return nearest
        for share in PARTS:
            end, _ = self._descended(pose.moved(share * pose.twist_to(nearest)), pose, joints)
            if self._is_free(pose, joints, end):
                length = self._machine.kinematics.characteristic_length
                is_nearer = float(distance(self._machine, pose, end)) > CLEARANCE * length
                return end if is_nearer else nearest
        return nearest

    def _is_free(self, pose: Pose, joints: Array, end: Pose) -> bool:
        machine = self._machine
        line = line_between(machine, pose, end)
        limits, there = machine.constraints, machine.kinematics.inverse_along(line, joints)
        values = limits.values(line, there)
        margins = np.minimum(values - limits.low, limits.high - values)
        return bool((margins > SPARE).all())

    def _descended(self, target: Pose, pose: Pose, joints: Array) -> tuple[Pose, Array]:
        machine = self._machine
        clearance = CLEARANCE * machine.kinematics.characteristic_length
        if not machine.constraints.is_one_group:
            return _by_joints(machine, target, joints, clearance)
        end = machine.constraints.descended(Search(target, clearance, MOST_STEPS), pose)
        return _slid(machine, target, end, clearance), joints


def _words(pose: Pose, goal: Pose, reason: str) -> str:
    gap = pose.twist_to(goal)
    metres, radians = (float(np.linalg.norm(part)) for part in (gap[:3], gap[3:]))
    return (
        f'nearest reachable pose, {1e3 * metres:.3g} mm and {np.degrees(radians):.3g}° from the '
        f'goal: {reason}'
    )


def _slid(machine: Machine, target: Pose, pose: Pose, clearance: float) -> Pose:
    """On from an admitted pose, along what keeps it from the target, as a wall that parts meet."""
    length = machine.kinematics.characteristic_length
    missed = float(distance(machine, pose, target))
    for _ in range(MOST_SLIDES):
        here = slopes(machine, pose)
        bound = np.isfinite(here.readings.margins) & (here.steepness > 0.0)
        steep = here.steepness[bound]
        normals, slack = (
            here.gradients[bound] / steep[:, None],
            here.readings.margins[bound] / steep,
        )
        step, _ = nearest_point(offset(machine, pose, target), normals, slack - clearance)
        trials = displaced(machine, pose, SLIDES[:, None] * step)
        left = distance(machine, trials, target)
        is_better = admits(machine, trials) & (left < missed - SETTLED * length)
        if not is_better.any():
            break
        best = int(np.argmax(is_better))
        pose, missed = trials[best], float(left[best])
    return pose


def _by_joints(
    machine: Machine, target: Pose, joints: Array, clearance: float
) -> tuple[Pose, Array]:
    """Down the distance by Levenberg and Marquardt's method, each step within linear limits."""
    kinematics, length = machine.kinematics, machine.kinematics.characteristic_length
    pose = kinematics.forward_along(joints, kinematics.home)
    least = min(LEAST_SIGMA, float(kinematics.sigma_min(pose, joints)))
    missed, damping = float(distance(machine, pose, target)), DIFFERENCE
    for _ in range(MOST_STEPS):
        step = _step(machine, target, joints, clearance, least, damping * length**2)
        trial = joints + step * min(1.0, LONGEST_STEP / max(float(np.abs(step).max()), DIFFERENCE))
        there = kinematics.forward_along(trial, pose)
        left = float(distance(machine, there, target))
        if left < missed and bool(machine.constraints.admits(there, trial)):
            is_settled = missed - left < SETTLED * length
            pose, joints, missed, damping = there, trial, left, max(EASED * damping, LEAST_DAMPED)
            if is_settled:
                break
        elif damping > MOST_DAMPED:
            break
        else:
            damping *= DAMPED
    return pose, joints


def _step(
    machine: Machine, target: Pose, joints: Array, clearance: float, least: float, damping: float
) -> Array:
    """The best step of the joints (n,) within their limits, both to first order."""
    kinematics = machine.kinematics
    rows = joints + DIFFERENCE * np.eye(1 + len(joints), len(joints), -1)
    margins, poses = _margins(machine, rows, clearance, least)
    pose = poses[0]
    jacobian = scale(machine)[:, None] * kinematics.jacobian(pose, joints)
    root = np.linalg.cholesky(jacobian.T @ jacobian + damping * np.eye(len(joints)))
    inverse = np.linalg.inv(root)
    best = inverse @ (jacobian.T @ offset(machine, pose, target))
    slopes = ((margins[1:] - margins[0]) / DIFFERENCE).T
    found, _ = nearest_point(best, slopes @ inverse.T, margins[0])
    step: Array = inverse.T @ found
    return step


def _margins(
    machine: Machine, joints: Array, clearance: float, least: float
) -> tuple[Array, Pose]:
    """How far inside all limits joints (k, n) are, and their poses."""
    kinematics, limits = machine.kinematics, machine.constraints
    poses = kinematics.forward_along(joints, kinematics.home)
    values = limits.values(poses, joints)
    sides = np.concatenate([values - limits.low, limits.high - values], axis=-1)
    is_bound = np.isfinite(sides[0])
    sigma = kinematics.sigma_min(poses, joints)[:, None] - least
    return np.concatenate([sides[:, is_bound] - clearance, sigma], axis=-1), poses
