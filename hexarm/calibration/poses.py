"""`hexarm calibrate poses MACHINE`: which poses to measure, as a table to be filled in."""

import argparse
from pathlib import Path

import numpy as np

from hexapod_control.identification.leg_model import Tolerances
from hexarm.calibration.machine_model import machine_model, random_poses
from hexarm.calibration.pose_table import planned
from hexarm.machines import load
from manipulator.arrays import Array
from manipulator.errors import InvalidInput
from manipulator.identification.device_frames import COUNT, DeviceFrames
from manipulator.identification.measurements import Noise
from manipulator.identification.model import Model
from manipulator.identification.observability import scales
from manipulator.identification.pose_choice import in_driving_order, most_telling
from manipulator.machine import Machine
from manipulator.pose import Pose
from manipulator.words import counted

CANDIDATES = 3000
MOST = 1000
KEPT_FROM_SINGULARITY = 0.25
"""Of the candidates, those nearest to a singularity: there an unmeasured machine may jump."""

TOLERANCES = Tolerances(5e-4, np.radians(1.0))
NOISE = Noise(1e-4, 1e-3)


def add_parser(parts: 'argparse._SubParsersAction[argparse.ArgumentParser]') -> None:
    """Declares the part."""
    parser = parts.add_parser('poses', help='which poses to measure, as a table to fill in')
    parser.add_argument('machine', metavar='MACHINE', help='a shipped name or the path of a file')
    parser.add_argument('--count', type=int, default=40, metavar='N', help='default 40')
    parser.add_argument('-o', '--output', metavar='FILE', help='default: standard output')
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    """Writes the table; InvalidInput where the file is there already."""
    if not 1 <= arguments.count <= MOST:
        raise InvalidInput(f'--count {arguments.count} outside [1, {MOST}]')
    if arguments.output and Path(arguments.output).exists():
        raise InvalidInput(f'{arguments.output} exists already: it is not overwritten')
    machine = load(arguments.machine)
    model = machine_model(machine.kinematics, TOLERANCES)
    joints, poses = telling_poses(machine, model, NOISE, arguments.count)
    kinematics = machine.kinematics
    text = planned(kinematics.joint_names, kinematics.joint_unit, joints, poses)
    if not arguments.output:
        print(text, end='')
        return 0
    try:
        Path(arguments.output).write_text(text)
    except OSError as error:
        raise InvalidInput(f'{arguments.output} cannot be written: {error.strerror}') from error
    print(f'{arguments.output}: {counted(len(joints), "pose")}; fill in the last seven columns')
    return 0


def telling_poses(machine: Machine, model: Model, noise: Noise, count: int) -> tuple[Array, Pose]:
    """Joints (count, m) and poses, in an order that is short to drive.

    The most telling of random poses of the whole workspace, away from singularities.
    """
    kinematics = machine.kinematics
    length = kinematics.characteristic_length
    joints, poses = random_poses(machine, max(CANDIDATES, 4 * count), np.random.default_rng(1))
    margins = kinematics.sigma_min(poses, joints)
    kept = margins >= np.quantile(margins, KEPT_FROM_SINGULARITY)
    joints, poses = joints[kept], poses[kept]
    own = model.slopes(np.zeros(len(model.parameters)), joints, poses)
    slopes = DeviceFrames.known().slopes(np.zeros(COUNT), poses, own)
    scale = scales((*model.parameters, *DeviceFrames.parameters()))
    weighted = slopes * noise.weights[:, None]
    chosen = np.array(most_telling(weighted, scale, count))
    ways = kinematics.home.twist_to(poses[chosen]) * ([1.0] * 3 + [length] * 3)
    order = chosen[in_driving_order(ways)]
    return joints[order], poses[order]
