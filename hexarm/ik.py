"""`hexarm ik MACHINE --xyz X Y Z --rpy R P Y`: the joints of a pose."""

import argparse
import math

from hexarm.answers import Answer, add_machine, add_pose, answering
from hexarm.machines import load
from manipulator.pose import Pose


def add_parser(commands: 'argparse._SubParsersAction[argparse.ArgumentParser]') -> None:
    """Declares the subcommand."""
    parser = commands.add_parser('ik', help='the joints of a pose, or why it is out of reach')
    add_machine(parser)
    add_pose(parser)
    parser.set_defaults(run=answering(answer))


def answer(arguments: argparse.Namespace) -> Answer:
    """Joint positions in radians or metres; a pose beyond any limit is refused."""
    machine = load(arguments.machine)
    pose = Pose.from_xyz_rpy(arguments.xyz, arguments.rpy)
    kinematics = machine.kinematics
    joints = kinematics.inverse(pose)
    machine.constraints.check(pose, joints)
    names, positions = list(kinematics.joint_names), joints.tolist()
    lines = [
        f'{name:<12} {in_words(position, kinematics.joint_unit)}'
        for name, position in zip(names, positions, strict=True)
    ]
    return {'joints': {'names': names, 'positions': positions}}, lines


def in_words(position: float, unit: str) -> str:
    """A joint position for people: radians with degrees, or metres with millimetres."""
    if unit == 'rad':
        return f'{position:>11.6f} rad {math.degrees(position):>10.4f}°'
    return f'{position:>11.6f} m   {position * 1e3:>10.4f} mm'
