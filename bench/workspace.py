"""Reach and workspace of the crank machine: poses a second, volumes, accuracy."""

import dataclasses
import time

import numpy as np

from bench.row import Row, best_time
from hexapod_control.workspace import sample
from hexarm.machines import load
from manipulator.analysis.accuracy import JointErrors, drawn_spread, linear_spread
from manipulator.analysis.free_paths import admits
from manipulator.analysis.nearest import nearest_reachable
from manipulator.analysis.reach import reach
from manipulator.analysis.readings import displaced
from manipulator.analysis.survey import SomeOrientation
from manipulator.analysis.volume import bounding_box, volume, with_orientation
from manipulator.limits.constraints import Constraints
from manipulator.limits.machine_limits import BodyHeight, JointRange
from manipulator.machine import Machine
from manipulator.pose import Pose

POSES = 500_000
GOAL = 4e6


def rows() -> list[Row]:
    machine = load('robocake')
    return [
        *speed_rows(machine),
        *reach_rows(machine),
        *volume_rows(machine),
        *accuracy_rows(machine),
    ]


def speed_rows(machine: Machine) -> list[Row]:
    """In the box about the workspace, and where no pose can be ruled out early: inside it."""
    few = tuple(
        limit
        for limit in machine.constraints.limits
        if isinstance(limit, JointRange | BodyHeight) or limit.quantity.startswith('rod')
    )
    mask = dataclasses.replace(machine, constraints=Constraints(few))
    home = machine.kinematics.home
    box = bounding_box(with_orientation(machine, home.rotation), home.position, 0.03)
    places = box.lattice(POSES, np.full(3, 0.5))
    boxed = Pose(places, np.broadcast_to(home.rotation, (POSES, 3, 3)))
    one = sample(machine, 10_000, np.random.default_rng(1))
    copies = POSES // 10_000
    inside = Pose(np.tile(one.position, (copies, 1)), np.tile(one.rotation, (copies, 1, 1)))
    found = []
    for name, subject, poses, goal in (
        ('closure, crank range, height', mask, boxed, GOAL),
        ('closure, crank range, height', mask, inside, GOAL),
        ('all limits', machine, boxed, GOAL),
        ('all limits', machine, inside, GOAL),
    ):
        where = 'box' if poses is boxed else 'workspace'
        rate = POSES / best_time(lambda m=subject, p=poses: admits(m, p))
        text = f'{rate / 1e6:.2f} million/s'
        title = f'poses of the {where}: {name}'
        found.append(Row(title, text, f'{goal / 1e6:g} million/s', rate >= goal))
    return found


def reach_rows(machine: Machine) -> list[Row]:
    generator = np.random.default_rng(2)
    home, length = machine.kinematics.home, machine.kinematics.characteristic_length
    targets = displaced(machine, home, generator.standard_normal((20, 6)) * 0.5 * length)
    times, gains = [], []
    for k in range(20):
        before = time.perf_counter()
        found = nearest_reachable(machine, targets[k])
        times.append(time.perf_counter() - before)
        gains.append(found.distance - best_by_search(machine, found.pose, targets[k], generator))
    seconds = best_time(lambda: reach(machine, targets[0]))
    return [
        Row('reach of one pose, every limit and its distance', f'{1e3 * seconds:.2f} ms'),
        Row(
            'nearest reachable pose, median',
            f'{1e3 * np.median(times):.1f} ms',
            '5 ms',
            bool(np.median(times) <= 5e-3),
        ),
        Row(
            'nearest reachable pose: improvement by random search',
            f'{1e3 * max(gains):.4f} mm at most',
            '0.02 mm',
            max(gains) <= 2e-5,
        ),
    ]


def best_by_search(
    machine: Machine, pose: Pose, target: Pose, generator: np.random.Generator
) -> float:
    length = machine.kinematics.characteristic_length
    best = float(np.linalg.norm(pose.twist_to(target) * ([1.0] * 3 + [length] * 3)))
    for radius in (3e-2, 1e-2, 1e-3, 1e-4, 1e-5):
        trials = displaced(machine, pose, generator.standard_normal((2000, 6)) * radius * length)
        steps = trials.twist_to(target) * ([1.0] * 3 + [length] * 3)
        distances = np.linalg.norm(steps, axis=1)
        inside = admits(machine, trials)
        best = min(best, float(distances[inside].min(initial=np.inf)))
    return best


def volume_rows(machine: Machine) -> list[Row]:
    home = machine.kinematics.home
    rods = [x for x in machine.constraints.limits if x.quantity.startswith('rod')]
    found = []
    for name, cranks, litres in (
        ('free cranks', None, 0.0235),
        ('cranks in [30°, 210°]', (30, 210), 0.0223),
        ('cranks in [0°, 180°]', (0, 180), 0.0160),
    ):
        limits = [*rods, BodyHeight(0.0)]
        if cranks:
            low, high = (np.full(6, np.radians(end)) for end in cranks)
            limits.append(JointRange(low, high, machine.kinematics.joint_names))
        free = dataclasses.replace(machine, constraints=Constraints(tuple(limits)))
        reached = with_orientation(free, home.rotation)
        box = bounding_box(reached, home.position, 0.03)
        v = volume(reached, box, 1_000_000, np.random.default_rng(1))
        text = f'{1e3 * v.value:.5f} ± {1e3 * v.error:.5f} dm³'
        close = abs(1e3 * v.value - litres) < 1e-4
        found.append(Row(f'volume unturned, z ≥ 0, {name}', text, f'{litres} dm³', close))
        if cranks is None:
            wide = bounding_box(SomeOrientation.of(free, 0.5, 20), home.position, 0.04, 4000)
            v = volume(SomeOrientation.of(free, 0.5, 150), wide, 16_000, np.random.default_rng(1))
            text = f'{1e3 * v.value:.4f} ± {1e3 * v.error:.4f} dm³'
            found.append(Row('volume, tilts up to ±0.5 rad, z ≥ 0, free cranks', text))
    return found


def accuracy_rows(machine: Machine) -> list[Row]:
    kinematics, generator = machine.kinematics, np.random.default_rng(1)
    found = []
    for name, chosen, check, paper in (
        ('all six', (0, 1, 2, 3, 4, 5), 0.205, 9.9),
        ('one', (0,), 0.082, 24.7),
        ('three', (0, 2, 4), 0.144, 30.0),
    ):
        errors = JointErrors.of(6, noise=np.radians(1.0)).on(chosen)
        law = 1e3 * float(linear_spread(kinematics, kinematics.home, errors).position_rms)
        drawn = drawn_spread(kinematics, kinematics.home, errors, 4000, generator)
        text = f'{law:.4f} mm, drawn {1e3 * drawn.position_rms:.4f} mm (paper {paper} µm)'
        found.append(
            Row(f'1° of noise, {name}', text, f'{check} mm', abs(law / check - 1) < 0.015)
        )
    return found
