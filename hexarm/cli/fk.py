"""`hexarm fk MACHINE A1 … A6`: the pose of joint positions, or with --all every one of them."""

import argparse
from typing import Any

import numpy as np

from hexapod_control.modes import Mode, all_modes
from hexarm.cli.answers import (
    Answer,
    Units,
    add_machine,
    add_units,
    answering,
    for_programs,
    units_of,
)
from hexarm.machines import load
from manipulator.arrays import Array
from manipulator.errors import InvalidInput, NoSolution
from manipulator.formatting import counted
from manipulator.machine import Machine
from manipulator.pose import Pose
from manipulator.unit_hints import check_turns


def add_parser(commands: 'argparse._SubParsersAction[argparse.ArgumentParser]') -> None:
    """Declares the subcommand."""
    parser = commands.add_parser('fk')
    add_machine(parser)
    add_units(parser)
    parser.add_argument(
        'joints',
        nargs='+',
        type=float,
        metavar='A',
        help='joint positions, rad or m (or °, mm)',
    )
    parser.add_argument(
        '--all', action='store_true', help='every assembly mode, not the usual one'
    )
    parser.set_defaults(run=answering(answer))


def answer(arguments: argparse.Namespace) -> Answer:
    """The pose that the joints mean from home, or all that they can mean."""
    machine = load(arguments.machine)
    names = machine.kinematics.joint_names
    units = units_of(arguments)
    joints = np.array(arguments.joints) / units.factor(machine.kinematics.joint_unit)
    if len(joints) != len(names):
        raise InvalidInput(
            f'{counted(len(joints), "joint position")}, {arguments.machine} has {len(names)}'
        )
    if machine.kinematics.joint_unit == 'rad':
        check_turns(joints.tolist(), names)
    answer_of = every_mode if arguments.all else from_home
    return answer_of(machine, joints, units)


def from_home(machine: Machine, joints: Array, units: Units) -> Answer:
    """The pose, how it was found, what it violates, and what else the joints may mean."""
    solution = machine.kinematics.forward(joints)
    pose = solution.pose
    violations = [str(v) for v in machine.constraints.violations(pose, joints)]
    counts, text = other_modes(machine, joints, pose)
    answer = {
        'pose': for_programs(pose),
        'iterations': solution.iterations,
        'residual': solution.residual,
        'sigma_min': solution.sigma_min,
        'violations': violations,
        **counts,
    }
    margin = f'singularity margin {solution.sigma_min:.3f}'
    search = [
        f'found in {counted(solution.iterations, "iteration")}, '
        f'residual {solution.residual * units.per_metre:.2g} {units.length}, {margin}',
        text,
    ]
    lines = [
        *units.pose(pose),
        *([margin] if counts['other_modes'] == 0 and not solution.iterations else search),
        *(f'beyond a limit: {v}' for v in violations),
    ]
    return answer, lines


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


def every_mode(machine: Machine, joints: Array, units: Units) -> Answer:
    """A table of all assembly modes, the highest first."""
    found = all_modes(machine, joints)
    modes = [
        {
            'pose': for_programs(mode.pose),
            'sigma_min': mode.sigma_min,
            'is_reachable': mode.is_reachable,
            'violations': [str(v) for v in mode.violations],
        }
        for mode in found.modes
    ]
    place, turn = f'x, y, z ({units.length})', f'roll, pitch, yaw ({units.angle})'
    lines = [f'{place:<33} {turn:<33} margin', *(table_row(mode, units) for mode in found.modes)]
    lines.append(
        f'{counted(len(modes), "mode")}, {len(found.that_fit)} reachable within all limits'
    )
    if not found.is_complete:
        lines.append('there may be more: close to a singularity not all can be distinguished')
    return {'modes': modes, 'is_complete': found.is_complete}, lines


def table_row(mode: Mode, units: Units) -> str:
    """One mode, and whether the machine can be in it."""
    xyz = '  '.join(units.number(v, 'm') for v in mode.pose.position)
    rpy = '  '.join(units.number(v, 'rad') for v in mode.pose.rpy)
    if mode.is_reachable:
        verdict = 'reachable'
    elif mode.violations:
        verdict = f'{mode.violations[0]}, limits broken: {len(mode.violations)}'
    else:
        verdict = 'beyond a singularity'
    return f'{xyz:<33} {rpy:<33} {mode.sigma_min:<7.3f} {verdict}'
