"""EAIK (C++): all branches by subproblem decomposition, on the UR5 and the PUMA 560."""

import time
from importlib.metadata import version

import numpy as np
from eaik.IK_HP import HPRobot

from arm_control.arm import SerialArm
from bench.peers.arm_library import ROUNDS, square
from bench.row import Row, interleaved_medians
from hexarm.machines import load

POSES, TURNS = 20_000, 5
SAME = 1e-4  # rad


def rows() -> list[Row]:
    name = f'EAIK {version("EAIK")}'
    found = []
    for machine in ('ur5', 'puma560'):
        arm = load(machine).kinematics
        found += [*single_rows(f'{name}, {machine}', arm), batch_row(f'{name}, {machine}', arm)]
    return found


def their_arm(arm: SerialArm) -> HPRobot:
    """Axes, and the ways from the base to each axis and to the tool."""
    places = np.vstack([np.zeros(3), arm.chain.points, arm.chain.home.position])
    return HPRobot(np.array(arm.chain.axes), np.diff(places, axis=0))


def problems(arm: SerialArm, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Joints (n, 6), and their poses (n, 4, 4) for EAIK, whose tool has base axes at zero."""
    joints = np.random.default_rng(4).uniform(-np.pi, np.pi, (count, 6))
    poses = arm.chain.forward(joints)
    squares = np.array([square(poses[k]) for k in range(count)])
    squares[:, :3, :3] = squares[:, :3, :3] @ arm.chain.home.rotation.T
    return joints, squares


def single_rows(name: str, arm: SerialArm) -> list[Row]:
    robot, (joints, squares) = their_arm(arm), problems(arm, ROUNDS)
    poses = arm.chain.forward(joints)
    each = [poses[k] for k in range(ROUNDS)]
    theirs, branches, nearest = interleaved_medians(
        [
            lambda k: robot.IK(squares[k]).Q,
            lambda k: arm.inverse_all(each[k], joints[k]),
            lambda k: arm.inverse(each[k], joints[k]),
        ],
        ROUNDS,
    )
    return [
        agreement_row(name, arm, robot),
        ratio_row(f'{name}: all branches', theirs, branches),
        ratio_row(f'{name}: all branches, our nearest to given joints', theirs, nearest),
    ]


def ratio_row(name: str, theirs: float, own: float) -> Row:
    text = f'{1e6 * theirs:.1f} µs, ours {1e6 * own:.1f} µs = {own / theirs:.2f}×'
    return Row(name, text, '≤ 1×', own <= theirs)


def agreement_row(name: str, arm: SerialArm, robot: HPRobot) -> Row:
    """Whether each branch of ours is among theirs."""
    joints, squares = problems(arm, 200)
    missing = 0
    for pose, matrix in zip(joints, squares, strict=True):
        branches = arm.inverse_all(arm.chain.forward(pose), pose)
        own, theirs = branches[np.isfinite(branches[:, 0])], np.array(robot.IK(matrix).Q)
        gaps = np.abs(np.exp(1j * own)[:, None] - np.exp(1j * theirs)).max(axis=-1)
        missing += int((gaps.min(axis=1) > SAME).sum())
    return Row(f'{name}: our branches that are not among theirs', str(missing), '0', missing == 0)


def batch_row(name: str, arm: SerialArm) -> Row:
    """Their batch on one thread and our nearest branches, the best of turns, a pose."""
    robot, (joints, squares) = their_arm(arm), problems(arm, POSES)
    poses, listed = arm.chain.forward(joints), list(squares)
    times = np.empty((TURNS, 2))
    for turn in range(TURNS):
        for column, task in enumerate(
            (lambda: robot.IK_batched(listed, 1), lambda: arm.inverse_or_nan(poses, joints))
        ):
            before = time.perf_counter()
            task()
            times[turn, column] = time.perf_counter() - before
    theirs, own = times.min(axis=0) / POSES
    return ratio_row(f'{name}: {POSES:,} poses, one core, each', theirs, own)
