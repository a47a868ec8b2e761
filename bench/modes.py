"""Assembly modes that a cold start confuses: share of poses inside and outside the workspace."""

from pathlib import Path

import numpy as np

from bench.honesty import honesty_rows, judged, starts
from bench.row import Row, interleaved_medians
from hexapod_control.load import hexapod
from hexapod_control.modes import all_modes
from hexapod_control.workspace import sample
from manipulator.config import build, parse_yaml
from manipulator.machine import Machine, MachineFile
from manipulator.pose import Pose

CONFIG = Path(__file__).parents[1] / 'config'
INSIDE, TIMED = 4000, 30
BOXES = {
    'robocake': ([-0.025, -0.025, 0.02339], [0.025, 0.025, 0.07]),
    'stewart_6_6': ([-0.15, -0.15, 0.1], [0.15, 0.15, 0.25]),
    'stewart_6_3': ([-0.15, -0.15, 0.1], [0.15, 0.15, 0.25]),
}


def rows() -> list[Row]:
    found = []
    for name, (low, high) in BOXES.items():
        file = build(MachineFile, parse_yaml((CONFIG / f'{name}.yaml').read_text()))
        machine = hexapod(file)
        poses = sample(machine, INSIDE, np.random.default_rng(4))
        found += inside_rows(name, machine, poses)
        found += honesty_rows(name, machine, np.array(low), np.array(high))
    return found


def inside_rows(name: str, machine: Machine, poses: Pose) -> list[Row]:
    joints = machine.kinematics.inverse(poses)
    wrong = 1.0 - judged(machine, poses, joints)['right']
    changed = 1.0 - judged(machine, poses, joints, starts(machine, poses))['right']
    some = [all_modes(machine, joints[k]) for k in range(0, INSIDE, INSIDE // TIMED)]
    (seconds,) = interleaved_medians([lambda k: all_modes(machine, joints[k])], TIMED)
    lone = all(len(modes.that_fit) == 1 for modes in some)
    return [
        share_row(f'{name}: wrong or refused, cold, inside', wrong),
        share_row(f'{name}: wrong or refused, warm from 2.5 mm away, inside', changed),
        Row(
            f'{name}: one mode fits, {len(some)} inside', 'all' if lone else 'not all', 'all', lone
        ),
        Row(f'{name}: all modes, judged', f'{1e3 * seconds:.1f} ms', '5 ms', seconds <= 5e-3),
    ]


def share_row(name: str, share: float) -> Row:
    return Row(name, f'{100 * share:.2f} %', '0 %', share == 0)
