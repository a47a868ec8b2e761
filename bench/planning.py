"""Goals: what planning one costs, in poses solved and in time, from random postures."""

from dataclasses import dataclass
from itertools import cycle, islice
from time import perf_counter

import numpy as np

from bench.row import Row, interleaved_medians
from hexarm.machines import load
from manipulator.arrays import Array
from manipulator.errors import ManipulatorError
from manipulator.machine import Machine
from manipulator.planning.goal import Goal, Motion
from manipulator.planning.plan import MotionState
from manipulator.planning.planner import plan_goal
from manipulator.planning.start import Start
from manipulator.planning.worker import MOST_POSES, Effort
from manipulator.pose import Pose

TICK = 0.01
GOALS = 200
MACHINES = ('robocake', 'stewart_6_6', 'arm_6r', 'ur5', 'puma560')
OTHERS = ('ar4_mk3', 'irb120', 'niryo_one', 'ur3e', 'vx300s', 'xarm6')
"""The other arms that are shipped: their median alone."""
SIZES = (0.01, 0.1, 0.5)
"""Of the characteristic length, and in rad: how far the goals are."""


@dataclass(frozen=True)
class Cost:
    """Of planning one goal."""

    seconds: float
    poses: int
    is_planned: bool


def rows() -> list[Row]:
    matrix, vector = np.random.default_rng(0).normal(size=(6, 6)), np.ones(6)
    solve = interleaved_medians([lambda _: np.linalg.solve(matrix, vector)], 2000)[0]
    found = []
    for name in MACHINES:
        costs = planned(load(name))
        seconds = np.array([cost.seconds for cost in costs])
        most = max(cost.poses for cost in costs)
        share = 100 * sum(cost.is_planned for cost in costs) / GOALS
        median, slow = (float(np.quantile(seconds, q)) for q in (0.5, 0.95))
        found += [
            median_row(name, median),
            Row(
                f'{name}: the same in 6×6 solves; p95', f'{median / solve:.0f}; {slow / solve:.0f}'
            ),
            Row(
                f'{name}: most poses solved for one',
                f'{most}',
                f'≤ {MOST_POSES}',
                most <= MOST_POSES,
            ),
            Row(f'{name}: goals with a plan; the others are refused', f'{share:.0f} %'),
        ]
    for name in OTHERS:
        seconds = [cost.seconds for cost in planned(load(name))]
        found.append(median_row(name, float(np.median(seconds))))
    return found


def median_row(name: str, median: float) -> Row:
    return Row(f'{name}: planning a goal, p50', f'{1e3 * median:.1f} ms', '≤ 10', median <= 0.01)


def planned(machine: Machine) -> list[Cost]:
    """GOALS random goals, near and far, from random poses that the machine can take."""
    rng, costs = np.random.default_rng(1), []
    for size, motion in islice(cycle((s, m) for s in SIZES for m in Motion), GOALS):
        pose, joints = posture(machine, rng)
        length = machine.kinematics.characteristic_length * size
        twist = np.concatenate([rng.normal(size=3) * length, rng.normal(size=3) * size])
        costs.append(cost(machine, pose, joints, Goal(pose.moved(twist), motion=motion)))
    return costs


def cost(machine: Machine, pose: Pose, joints: Array, goal: Goal) -> Cost:
    effort, start = Effort(), Start(MotionState.at_rest(pose), joints, TICK)
    begin = perf_counter()
    try:
        plan_goal(machine, start, goal, effort)
        is_planned = True
    except ManipulatorError:
        is_planned = False
    return Cost(perf_counter() - begin, effort.poses, is_planned)


def posture(machine: Machine, rng: np.random.Generator) -> tuple[Pose, Array]:
    """A pose about home that every limit admits, and its joints."""
    kinematics = machine.kinematics
    size = 0.3 * kinematics.characteristic_length
    while True:
        twist = np.concatenate([rng.normal(size=3) * size, rng.normal(size=3) * 0.1])
        pose = kinematics.home.moved(twist)
        joints = kinematics.inverse_or_nan(pose)
        if np.isfinite(joints).all() and machine.constraints.admits(pose, joints):
            return pose, joints
