"""Paths: planning time, deviation from the polyline, duration against its lower bound."""

import numpy as np

from bench.row import Row, interleaved_medians
from hexarm.machines import load
from manipulator.arrays import Array
from manipulator.machine import Machine
from manipulator.planning.path import Tolerance
from manipulator.planning.path_timing import PathRequest, TimedPath, plan_path
from manipulator.pose import Pose

TICK = 0.01
SHAPES = {'robocake': 0.008, 'stewart_6_3': 0.01, 'arm_6r': 0.08}


def rows() -> list[Row]:
    found = []
    for name, size in SHAPES.items():
        machine = load(name)
        long, round_way, square = (ring(machine, size, n) for n in (2000, 120, 5))
        seconds = interleaved_medians([lambda _, m=machine, w=long: planned(m, w)], 5)[0]
        found.append(Row(f'{name}: planning 2,000 poses', f'{seconds:.3f} s', '≤ 1', seconds <= 1))
        for shape, poses in (('circle of 120 poses', round_way), ('square', square)):
            plan = planned(machine, poses)
            off = 1e3 * deviation(plan, poses)
            ratio = plan.duration / bound(machine, poses)
            label = f'{name}, {shape}'
            found.append(Row(f'{label}: contour', f'{off:.4f} mm', '≤ 0.1', off <= 0.1))
            found.append(Row(f'{label}: time against length/speed', f'{ratio:.3f}'))
    return found


def ring(machine: Machine, size: float, count: int) -> Pose:
    """A closed way about home through `count` poses on a circle: 5 make a square."""
    angle = np.linspace(0.0, 2 * np.pi, count)
    home = machine.kinematics.home
    circle = size * np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
    return Pose(home.position + circle, home.rotation)


def planned(machine: Machine, poses: Pose) -> TimedPath:
    near = machine.kinematics.inverse(machine.kinematics.home)
    request = PathRequest(poses, machine.motion.linear.speed, Tolerance())
    plan = plan_path(machine, request, near, TICK)
    assert isinstance(plan, TimedPath)
    return plan


def deviation(plan: TimedPath, poses: Pose) -> float:
    """The largest distance of the way from the straight lines between the poses, in metres."""
    points = plan.at(np.linspace(0.0, plan.duration, 4000)).pose.position
    start, way = poses.position[:-1], np.diff(poses.position, axis=0)
    share = np.einsum('psi,si->ps', points[:, None] - start, way) / (way**2).sum(axis=1)
    nearest: Array = start + np.clip(share, 0.0, 1.0)[..., None] * way
    return float(np.linalg.norm(points[:, None] - nearest, axis=2).min(axis=1).max())


def bound(machine: Machine, poses: Pose) -> float:
    """No way along the poses is quicker than its length at the speed limit."""
    length = np.linalg.norm(np.diff(poses.position, axis=0), axis=1).sum()
    return float(length) / machine.motion.linear.speed
