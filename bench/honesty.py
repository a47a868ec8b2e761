"""How honest a cold start is where the machine should not be: outside its workspace."""

import numpy as np

from bench.row import Row
from manipulator import rotation as so3
from manipulator.arrays import Array
from manipulator.errors import NoSolution
from manipulator.machine import Machine
from manipulator.pose import Pose

TRIES = 3000
AWAY = 2.5e-3
ANSWERS = ('right', 'refused', 'wrong, but beyond a limit', 'the twin within all limits')
TWIN_AT_HOME = "a twin of a pose on home's side of every singularity"


def honesty_rows(name: str, machine: Machine, low: Array, high: Array) -> list[Row]:
    """For poses that close but break a limit, in a box of positions, by their largest tilt."""
    found = []
    for tilt in (0.25, 0.6):
        poses, joints = outside(machine, low, high, tilt, np.random.default_rng(3))
        head = f'{name}: cold start outside, tilt ≤ {tilt}'
        shares = judged(machine, poses, joints)
        found += [Row(f'{head}: {answer}', f'{100 * shares[answer]:.2f} %') for answer in ANSWERS]
        passed = shares[TWIN_AT_HOME]
        found.append(Row(f'{head}: {TWIN_AT_HOME}', f'{100 * passed:.2f} %', '0 %', passed == 0))
    return [*found, *warm_rows(f'{name}: warm start outside', machine, poses, joints)]


def warm_rows(head: str, machine: Machine, poses: Pose, joints: Array) -> list[Row]:
    """Starts five ticks away at full speed, or two and a half millimetres."""
    shares = judged(machine, poses, joints, starts(machine, poses))
    silent = shares['the twin within all limits']
    flagged = shares['wrong, but beyond a limit']
    return [
        Row(f'{head}, {1e3 * AWAY} mm away: wrong, but beyond a limit', f'{100 * flagged:.2f} %'),
        Row(
            f'{head}, {1e3 * AWAY} mm away: wrong within all limits',
            f'{100 * silent:.2f} %',
            '0 %',
            silent == 0,
        ),
    ]


def starts(machine: Machine, poses: Pose) -> Pose:
    """Poses AWAY from each in a random direction, turns made lengths."""
    twists = np.random.default_rng(2).standard_normal((*poses.position.shape[:-1], 6))
    twists *= AWAY / np.linalg.norm(twists, axis=-1, keepdims=True)
    twists[..., 3:] /= machine.kinematics.characteristic_length
    return poses.moved(twists)


def outside(
    machine: Machine, low: Array, high: Array, tilt: float, generator: np.random.Generator
) -> tuple[Pose, Array]:
    positions, rotations, angles, count = [], [], [], 0
    while count < TRIES:
        n = 200_000
        xyz = generator.uniform(low, high, (n, 3))
        axis = generator.standard_normal((n, 3))
        axis /= np.sqrt((axis * axis).sum(axis=1, keepdims=True))
        turn = so3.exp(axis * tilt * generator.uniform(0, 1, (n, 1)) ** (1 / 3))
        poses = Pose(xyz, turn)
        joints = machine.kinematics.inverse_or_nan(poses)
        closed = np.flatnonzero(np.isfinite(joints).all(axis=1))
        out = closed[~machine.constraints.admits(poses[closed], joints[closed])]
        positions.append(poses.position[out])
        rotations.append(poses.rotation[out])
        angles.append(joints[out])
        count += len(out)
    poses = Pose(np.concatenate(positions)[:TRIES], np.concatenate(rotations)[:TRIES])
    return poses, np.concatenate(angles)[:TRIES]


def judged(
    machine: Machine, poses: Pose, joints: Array, near: Pose | None = None
) -> dict[str, float]:
    """Shares of the answers; a twin is a pose within all limits that has the same joints."""
    kinematics = machine.kinematics
    counts = dict.fromkeys((*ANSWERS, TWIN_AT_HOME), 0)
    for k, q in enumerate(joints):
        start = None if near is None else near[k]
        try:
            found = kinematics.forward(q, start).pose
        except NoSolution:
            counts['refused'] += 1
            continue
        if np.abs(poses[k].twist_to(found)).max() < 1e-6:
            counts['right'] += 1
        elif machine.constraints.admits(found, q):
            counts['the twin within all limits'] += 1
            counts[TWIN_AT_HOME] += int(kinematics.is_as_at_home(poses[k], q))
        else:
            counts['wrong, but beyond a limit'] += 1
    return {name: count / len(joints) for name, count in counts.items()}
