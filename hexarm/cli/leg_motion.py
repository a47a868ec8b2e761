"""`hexarm leg-motion MACHINE --to X Y Z`: where a platform goes while its legs move linearly.

The experiment of Lapikov et al. 2014, section 4: `--legs 0.15 --to 0.02 0.02 0.2`.
"""

import argparse
from pathlib import Path

import numpy as np

from hexapod_control.leg_motion import LegMotion, leg_motion, level_pose
from hexapod_control.linear import LinearPlatform
from hexarm.cli.answers import Answer, add_machine, answering, picture_file
from hexarm.machines import load
from manipulator.arrays import Array
from manipulator.errors import InvalidInput
from manipulator.machine import Machine
from manipulator.pose import Pose
from manipulator.unit_hints import hint_at_metres

MOST_STEPS = 10_000
SHOWN = 10


def add_parser(commands: 'argparse._SubParsersAction[argparse.ArgumentParser]') -> None:
    """Declares the subcommand."""
    parser = commands.add_parser('leg-motion')
    add_machine(parser)
    parser.add_argument(
        '--to', nargs=3, type=float, required=True, metavar=('X', 'Y', 'Z'), help='metres, level'
    )
    parser.add_argument(
        '--legs', type=float, metavar='L', help='start level on legs of L metres (default: home)'
    )
    parser.add_argument('--steps', type=int, default=100, metavar='N', help='default 100')
    parser.add_argument('--picture', type=picture_file, metavar='FILE', help='save plots')
    parser.set_defaults(run=answering(answer))


def answer(arguments: argparse.Namespace) -> Answer:
    """Position, Euler angles and rotation vector step by step, and what is not linear in them."""
    machine = load(arguments.machine)
    if arguments.steps > MOST_STEPS:
        raise InvalidInput(f'{arguments.steps} steps, at most {MOST_STEPS}')
    motion = simulated(machine, arguments.legs, arguments.to, arguments.steps)
    beyond = first_violation(machine, motion)
    if arguments.picture is not None:
        from hexarm.pictures.leg_motion import draw  # noqa: PLC0415 (needs matplotlib)

        draw(motion, Path(arguments.machine).stem, arguments.picture)
    for_programs = {
        'share': motion.share.tolist(),
        'lengths': motion.lengths.tolist(),
        'xyz': motion.poses.position.tolist(),
        'euler_zxz': motion.euler_zxz.tolist(),
        'rotation_vector': motion.rotation_vectors.tolist(),
        'deviation': {
            'axis': axis_deviation(motion),
            'position': float(motion.position_deviation.max()),
            'angle': float(motion.angle_deviation.max()),
        },
        'beyond_a_limit': beyond,
    }
    lines = [*table(motion), said_of(motion), *([f'beyond a limit: {beyond}'] if beyond else [])]
    return for_programs, lines


def simulated(machine: Machine, legs: float | None, to: list[float], steps: int) -> LegMotion:
    """The motion; InvalidInput for legs that are not linear, Unreachable for its ends."""
    kinematics = machine.kinematics
    if not isinstance(kinematics, LinearPlatform):
        raise InvalidInput(f'leg-motion needs linear legs, not {kinematics.joint_names[0]}')
    start = kinematics.home if legs is None else level_pose(kinematics.geometry, legs)
    target = Pose.from_xyz_rpy(to)
    first, last = kinematics.inverse(start), kinematics.inverse(target)
    for pose, lengths in ((start, first), (target, last)):
        with hint_at_metres(kinematics, pose):
            machine.constraints.check(pose, lengths)

    def solve(lengths: Array, near: Pose) -> Pose:
        return kinematics.forward(lengths, near).pose

    return leg_motion(solve, first, last, start, steps)


def first_violation(machine: Machine, motion: LegMotion) -> str | None:
    """The first limit that is broken on the path, and where."""
    outside = ~machine.constraints.admits(motion.poses, motion.lengths)
    if not outside.any():
        return None
    step = int(np.argmax(outside))
    violation = machine.constraints.violations(motion.poses[step], motion.lengths[step])[0]
    return f'after {100 * motion.share[step]:.0f} % of the path: {violation}'


def axis_deviation(motion: LegMotion) -> float:
    """The most that one coordinate is off the straight motion's, metres."""
    return float(np.abs(motion.poses.position - motion.straight.position).max())


def table(motion: LegMotion) -> list[str]:
    """About ten of the steps: millimetres and degrees."""
    columns = np.column_stack(
        [
            100 * motion.share,
            1e3 * motion.poses.position,
            np.degrees(motion.euler_zxz),
            np.degrees(motion.rotation_vectors),
            1e3 * motion.position_deviation,
            np.degrees(motion.angle_deviation),
        ]
    )
    names = ['path (%)', 'x (mm)', 'y (mm)', 'z (mm)', 'α (°)', 'β (°)', 'γ (°)']
    names += ['rx (°)', 'ry (°)', 'rz (°)', 'off (mm)', 'off (°)']
    chosen = np.unique(np.linspace(0, len(columns) - 1, SHOWN + 1).round().astype(int))
    rows = np.round(columns[chosen], 4) + 0.0
    return [
        ' '.join(f'{name:>9}' for name in names),
        *(' '.join(f'{value:>9.4f}' for value in row) for row in rows),
    ]


def said_of(motion: LegMotion) -> str:
    """The largest deviation from a pose that is linear in time."""
    return (
        f'deviation from linear: at most {1e3 * motion.position_deviation.max():.3f} mm '
        f'({1e3 * axis_deviation(motion):.3f} mm on one axis) and '
        f'{np.degrees(motion.angle_deviation.max()):.4f}°'
    )
