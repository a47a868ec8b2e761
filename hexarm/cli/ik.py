"""`hexarm ik MACHINE --xyz X Y Z --rpy R P Y`: the joints of a pose, or with --all every set."""

import argparse
import math
from typing import Protocol, runtime_checkable

import numpy as np

from hexarm.cli.answers import Answer, add_machine, add_pose, answering, pose_asked
from hexarm.machines import load
from manipulator.arrays import Array
from manipulator.machine import Machine
from manipulator.pose import Pose
from manipulator.unit_hints import hint_at_metres


@runtime_checkable
class Branched(Protocol):
    """A kinematics with more than one set of joints for a pose."""

    def inverse_all(self, pose: Pose) -> Array:
        """One set a row; rows of NaN are branches that do not close."""
        ...


def add_parser(commands: 'argparse._SubParsersAction[argparse.ArgumentParser]') -> None:
    """Declares the subcommand."""
    parser = commands.add_parser('ik', help='the joints of a pose, or why it is out of reach')
    add_machine(parser)
    add_pose(parser)
    parser.add_argument('--all', action='store_true', help='every branch, also beyond limits')
    parser.set_defaults(run=answering(answer))


def answer(arguments: argparse.Namespace) -> Answer:
    """Joint positions in radians or metres; a pose beyond any limit is refused."""
    machine = load(arguments.machine)
    pose = pose_asked(arguments)
    kinematics = machine.kinematics
    with hint_at_metres(kinematics, pose):
        joints = kinematics.inverse(pose)
        if arguments.all:
            return every_branch(machine, pose)
        machine.constraints.check(pose, joints)
    names, positions = list(kinematics.joint_names), joints.tolist()
    lines = [
        f'{name:<12} {in_words(position, kinematics.joint_unit)}'
        for name, position in zip(names, positions, strict=True)
    ]
    return {'joints': {'names': names, 'positions': positions}}, lines


def every_branch(machine: Machine, pose: Pose) -> Answer:
    """All sets of joints for the pose, one a row, with the limits that each violates."""
    kinematics = machine.kinematics
    found = kinematics.inverse(pose)[None]
    if isinstance(kinematics, Branched):
        found = kinematics.inverse_all(pose)
    closed = found[np.isfinite(found).all(axis=1)]
    violations = [[str(v) for v in machine.constraints.violations(pose, q)] for q in closed]
    names, positions = list(kinematics.joint_names), closed.tolist()
    branches = [
        {'positions': q, 'violations': broken}
        for q, broken in zip(positions, violations, strict=True)
    ]
    is_rotary = kinematics.joint_unit == 'rad'
    shown, unit = (np.degrees(closed), '°') if is_rotary else (1e3 * closed, 'mm')
    headers = [f'{name} ({unit})' for name in names]
    lines = [
        '  '.join(f'{header:>12}' for header in headers),
        *(
            '  '.join(f'{value:>12.4f}' for value in row) + (f'  {broken[0]}' if broken else '')
            for row, broken in zip(shown, violations, strict=True)
        ),
    ]
    return {'names': names, 'branches': branches}, lines


def in_words(position: float, unit: str) -> str:
    """A joint position for people: radians with degrees, or metres with millimetres."""
    if unit == 'rad':
        return f'{position:>11.6f} rad {math.degrees(position):>10.4f}°'
    return f'{position:>11.6f} m   {position * 1e3:>10.4f} mm'
