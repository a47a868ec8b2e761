"""The crank hexapod's kinematics, against one 6×6 linear solve in the same run."""

from pathlib import Path

import numpy as np

from bench.row import Row, best_time, interleaved_medians
from hexapod_control.load import hexapod
from hexapod_control.workspace import axis_range, sample
from manipulator.config import build, parse_yaml
from manipulator.machine import Machine, MachineFile
from manipulator.pose import Pose

ROBOCAKE = Path(__file__).parents[1] / 'config' / 'robocake.yaml'
TICK_SPEED, TICK = 0.05, 0.01
POSES = 10_000
ROUNDS = 3000


def rows() -> list[Row]:
    machine = hexapod(build(MachineFile, parse_yaml(ROBOCAKE.read_text())))
    generator = np.random.default_rng(1)
    poses = sample(machine, POSES, generator)
    return [
        *geometry_rows(machine),
        *closure_rows(machine, poses),
        *speed_rows(machine, poses, generator),
        array_row(machine, poses),
    ]


def geometry_rows(machine: Machine) -> list[Row]:
    kinematics = machine.kinematics
    home = np.degrees(kinematics.inverse(kinematics.home))
    text = f'{home.min():.4f} to {home.max():.4f}°'
    found = [Row('home, all six cranks', text, '120.0045°', bool(np.ptp(home) < 1e-9))]
    for axis, name in enumerate(['x', 'y', 'z', 'roll', 'pitch', 'yaw']):
        scale, unit = (1e3, 'mm') if axis < 3 else (1.0, 'rad')
        low, high = (scale * end for end in axis_range(machine, axis))
        found.append(
            Row(f'range of {name} from home, all limits', f'{low:.3f} to {high:.3f} {unit}')
        )
    return found


def closure_rows(machine: Machine, poses: Pose) -> list[Row]:
    kinematics = machine.kinematics
    joints = kinematics.inverse(poses)
    rods = poses.transform(kinematics.geometry.platform_points) - kinematics.crank_tips(joints)
    lengths = np.sqrt((rods * rods).sum(axis=-1))
    error = 1e3 * np.abs(lengths - kinematics.geometry.rod_lengths).max()
    solutions = [kinematics.forward(q) for q in joints]
    found = Pose(
        np.stack([s.pose.position for s in solutions]),
        np.stack([s.pose.rotation for s in solutions]),
    )
    misses = np.abs(poses.twist_to(found))
    place, turn = 1e3 * misses[:, :3].max(), misses[:, 3:].max()
    most = max(s.iterations for s in solutions)
    return [
        Row(f'rod length error, {POSES} poses', f'{error:.1e} mm', '1e-9 mm', error <= 1e-9),
        Row('forward of inverse, position', f'{place:.1e} mm', '1e-6 mm', bool(place <= 1e-6)),
        Row('forward of inverse, rotation', f'{turn:.1e} rad', '1e-8 rad', bool(turn <= 1e-8)),
        Row('iterations from home, at most', str(most), '6', most <= 6),
    ]


def speed_rows(machine: Machine, poses: Pose, generator: np.random.Generator) -> list[Row]:
    kinematics = machine.kinematics
    single = [poses[k] for k in range(ROUNDS)]
    joints = kinematics.inverse(poses)
    directions = generator.standard_normal((POSES, 6)) * ([1.0] * 3 + [0.0] * 3)
    directions *= TICK_SPEED * TICK / np.sqrt((directions**2).sum(axis=1, keepdims=True))
    before = poses.moved(directions)
    starts = [before[k] for k in range(ROUNDS)]
    matrices, right = generator.standard_normal((ROUNDS, 6, 6)), generator.standard_normal(6)
    solve, inverse, near, warm, cold = interleaved_medians(
        [
            lambda k: np.linalg.solve(matrices[k], right),
            lambda k: kinematics.inverse(single[k]),
            lambda k: kinematics.inverse(single[k], joints[k]),
            lambda k: kinematics.forward(joints[k], starts[k]),
            lambda k: kinematics.forward(joints[k]),
        ],
        ROUNDS,
    )

    def row(name: str, seconds: float, goal: float) -> Row:
        ratio = seconds / solve
        return Row(name, f'{1e6 * seconds:.2f} µs = {ratio:.2f}×', f'{goal:g}×', ratio <= goal)

    return [
        Row('one 6×6 numpy.linalg.solve', f'{1e6 * solve:.1f} µs'),
        row('inverse', inverse, 0.5),
        row('inverse near given joints', near, 0.5),
        row('forward, warm: 0.5 mm away', warm, 2),
        row('forward, cold: from home', cold, 2),
    ]


def array_row(machine: Machine, poses: Pose) -> Row:
    many = Pose(np.tile(poses.position, (100, 1)), np.tile(poses.rotation, (100, 1, 1)))
    seconds = best_time(lambda: machine.kinematics.inverse(many))
    rate = 100 * POSES / seconds
    return Row(
        'inverse of 1,000,000 poses', f'{rate / 1e6:.1f} million/s', '8 million/s', rate >= 8e6
    )
