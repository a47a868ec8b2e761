"""`hexarm fk MACHINE A1 … A6`: the pose of joint positions, or with --all every one of them."""

import argparse
from typing import Any

import numpy as np

from hexapod_control.modes import Mode, all_modes
from hexarm.cli.answers import Answer, add_machine, answering
from hexarm.machines import load
from manipulator.arrays import Array
from manipulator.errors import InvalidInput, NoSolution
from manipulator.formatting import counted
from manipulator.machine import Machine
from manipulator.pose import Pose
from manipulator.unit_hints import check_turns


def add_parser(commands: 'argparse._SubParsersAction[argparse.ArgumentParser]') -> None:
    """Declares the subcommand."""
    parser = commands.add_parser('fk', help='the pose of joint positions')
    add_machine(parser)
    parser.add_argument(
        'joints', nargs='+', type=float, metavar='A', help='joint positions in radians or metres'
    )
    parser.add_argument(
        '--all', action='store_true', help='every assembly mode, not the usual one'
    )
    parser.set_defaults(run=answering(answer))


def answer(arguments: argparse.Namespace) -> Answer:
    """The pose that the joints mean from home, or all that they can mean."""
    machine = load(arguments.machine)
    names = machine.kinematics.joint_names
    joints = np.array(arguments.joints)
    if len(joints) != len(names):
        raise InvalidInput(
            f'{counted(len(joints), "joint position")}, {arguments.machine} has {len(names)}'
        )
    if machine.kinematics.joint_unit == 'rad':
        check_turns(arguments.joints, names)
    return every_mode(machine, joints) if arguments.all else from_home(machine, joints)


def from_home(machine: Machine, joints: Array) -> Answer:
    """The pose, how it was found, what it violates, and what else the joints may mean."""
    solution = machine.kinematics.forward(joints)
    pose = solution.pose
    violations = [str(v) for v in machine.constraints.violations(pose, joints)]
    counts, text = other_modes(machine, joints, pose)
    for_programs = {
        'pose': for_program(pose),
        'iterations': solution.iterations,
        'residual': solution.residual,
        'sigma_min': solution.sigma_min,
        'violations': violations,
        **counts,
    }
    xyz, rpy = in_words(pose)
    lines = [
        f'x, y, z            {xyz} mm',
        f'roll, pitch, yaw   {rpy} °',
        f'found in {counted(solution.iterations, "iteration")}, '
        f'residual {solution.residual:.2g} m, '
        f'singularity margin {solution.sigma_min:.3f}',
        text,
        *(f'beyond a limit: {v}' for v in violations),
    ]
    return for_programs, lines


def other_modes(machine: Machine, joints: Array, pose: Pose) -> tuple[dict[str, Any], str]:
    """How many other poses the joints allow, and how many of these the machine could be in."""
    keys = ('other_modes', 'other_modes_reachable')
    try:
        others = all_modes(machine, joints).other_than(pose)
    except NoSolution as error:
        return dict.fromkeys(keys), f'other assembly modes are not known: {error}'
    fitting = sum(mode.is_reachable for mode in others)
    text = f'other assembly modes: {len(others)}'
    if fitting:
        text += (
            f', {fitting} of them reachable as well: which it is does not follow from these joints'
        )
    return dict(zip(keys, (len(others), fitting), strict=True)), text


def every_mode(machine: Machine, joints: Array) -> Answer:
    """A table of all assembly modes, the highest first."""
    found = all_modes(machine, joints)
    modes = [
        {
            'pose': for_program(mode.pose),
            'sigma_min': mode.sigma_min,
            'is_reachable': mode.is_reachable,
            'violations': [str(v) for v in mode.violations],
        }
        for mode in found.modes
    ]
    header = f'{"x, y, z (mm)":<33} {"roll, pitch, yaw (°)":<33} margin'
    lines = [header, *(table_row(mode) for mode in found.modes)]
    lines.append(
        f'{counted(len(modes), "mode")}, {len(found.that_fit)} reachable within all limits'
    )
    if not found.is_complete:
        lines.append('there may be more: close to a singularity not all can be distinguished')
    return {'modes': modes, 'is_complete': found.is_complete}, lines


def table_row(mode: Mode) -> str:
    """One mode, and whether the machine can be in it."""
    xyz, rpy = in_words(mode.pose)
    if mode.is_reachable:
        verdict = 'reachable'
    elif mode.violations:
        verdict = f'{mode.violations[0]}, limits broken: {len(mode.violations)}'
    else:
        verdict = 'beyond a singularity'
    return f'{xyz:<33} {rpy:<33} {mode.sigma_min:<7.3f} {verdict}'


def for_program(pose: Pose) -> dict[str, list[float]]:
    """Metres and a unit quaternion."""
    return {'xyz': pose.position.tolist(), 'quaternion_xyzw': pose.quaternion.tolist()}


def in_words(pose: Pose) -> tuple[str, str]:
    """Millimetres and degrees."""
    xyz, rpy = (np.round(v, 4) + 0.0 for v in (1e3 * pose.position, np.degrees(pose.rpy)))
    return '  '.join(f'{v:.4f}' for v in xyz), '  '.join(f'{v:.4f}' for v in rpy)
