"""`hexarm fk MACHINE A1 … A6`: the pose of joint positions."""

import argparse

import numpy as np

from hexarm.answers import Answer, add_machine, answering
from hexarm.machines import load
from manipulator.errors import InvalidInput


def add_parser(commands: 'argparse._SubParsersAction[argparse.ArgumentParser]') -> None:
    """Declares the subcommand."""
    parser = commands.add_parser('fk', help='the pose of joint positions')
    add_machine(parser)
    parser.add_argument(
        'joints', nargs='+', type=float, metavar='A', help='joint positions in radians or metres'
    )
    parser.set_defaults(run=answering(answer))


def answer(arguments: argparse.Namespace) -> Answer:
    """The pose with how it was found, and every limit that it violates."""
    machine = load(arguments.machine)
    names = machine.kinematics.joint_names
    joints = np.array(arguments.joints)
    if len(joints) != len(names):
        raise InvalidInput(f'{len(joints)} joint positions, {arguments.machine} has {len(names)}')
    solution = machine.kinematics.forward(joints)
    pose = solution.pose
    violations = [str(v) for v in machine.constraints.violations(pose, joints)]
    for_programs = {
        'pose': {'xyz': pose.position.tolist(), 'quaternion_xyzw': pose.quaternion.tolist()},
        'iterations': solution.iterations,
        'residual': solution.residual,
        'sigma_min': solution.sigma_min,
        'violations': violations,
    }
    xyz = '  '.join(f'{1e3 * v:.4f}' for v in pose.position)
    rpy = '  '.join(f'{v:.4f}' for v in np.degrees(pose.rpy))
    lines = [
        f'x, y, z            {xyz} mm',
        f'roll, pitch, yaw   {rpy} °',
        f'found in {solution.iterations} iterations, residual {solution.residual:.2g} m, '
        f'singularity margin {solution.sigma_min:.3f}',
        *(f'beyond a limit: {v}' for v in violations),
    ]
    return for_programs, lines
