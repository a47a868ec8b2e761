"""Serial arms: kinematics and the jog tick, against one 6×6 linear solve in the same run."""

import time
from pathlib import Path

import numpy as np

from arm_control.load import jogging
from arm_control.resolved_rate import JogState, ResolvedRate
from bench.arm_jog import jog_rows
from bench.row import Row, interleaved_medians
from manipulator.config import build, parse_yaml
from manipulator.machine import MachineFile
from manipulator.pose import Pose

CONFIG = Path(__file__).parents[1] / 'config'
ARMS = ('arm_6r', 'ur5', 'puma560')
TICK = 0.01
ROUNDS = 3000
POSES = 2000


def rows() -> list[Row]:
    found = []
    for name in ARMS:
        jog = jogging(build(MachineFile, parse_yaml((CONFIG / f'{name}.yaml').read_text())))
        found += [*speed_rows(name, jog), closure_row(name, jog)]
    file = build(MachineFile, parse_yaml((CONFIG / 'arm_6r.yaml').read_text()))
    return found + jog_rows(file)


def speed_rows(name: str, jog: ResolvedRate) -> list[Row]:
    rng = np.random.default_rng(1)
    arm = jog.arm
    joints = rng.uniform(arm.limits.low, arm.limits.high, (ROUNDS, 6))
    states = [JogState.at_rest(q) for q in joints]
    twists = rng.uniform(-1, 1, (ROUNDS, 6)) * ([0.2] * 3 + [1.0] * 3)
    matrices, right = rng.normal(size=(ROUNDS, 6, 6)), rng.normal(size=6)
    poses = arm.chain.forward(joints)
    each = [poses[k] for k in range(ROUNDS)]
    solve, tick, jacobian, forward, inverse = interleaved_medians(
        [
            lambda k: np.linalg.solve(matrices[k], right),
            lambda k: jog.step(states[k], twists[k], TICK),
            lambda k: arm.chain.jacobian(joints[k]),
            lambda k: arm.chain.forward(joints[k]),
            lambda k: arm.inverse_all(each[k], joints[k]),
        ],
        ROUNDS,
    )
    ratio, slowest = tick / solve, cpu_p99(jog, states, twists)
    return [
        Row(f'{name}: one jog tick', f'{ratio:.1f} × a 6×6 solve', '≤ 8', ratio <= 8),
        Row(
            f'{name}: one jog tick, CPU at p99', f'{1e3 * slowest:.3f} ms', '≤ 1', slowest <= 1e-3
        ),
        Row(f'{name}: Jacobian', f'{jacobian / solve:.1f} × a 6×6 solve'),
        Row(f'{name}: forward', f'{forward / solve:.1f} × a 6×6 solve'),
        Row(f'{name}: all eight branches', f'{inverse / solve:.0f} × a 6×6 solve'),
    ]


def cpu_p99(jog: ResolvedRate, states: list[JogState], twists: np.ndarray) -> float:
    taken = []
    for state, twist in zip(states, twists, strict=True):
        before = time.thread_time_ns()
        jog.step(state, twist, TICK)
        taken.append(time.thread_time_ns() - before)
    return float(np.percentile(taken, 99)) * 1e-9


def closure_row(name: str, jog: ResolvedRate) -> Row:
    """All branches driven forward again, over joint angles of the whole range."""
    arm, rng = jog.arm, np.random.default_rng(2)
    poses = arm.chain.forward(rng.uniform(arm.limits.low, arm.limits.high, (POSES, 6)))
    branches = arm.inverse_all(poses)
    closes = ~np.isnan(branches).any(axis=-1)
    reached = arm.chain.forward(np.where(closes[..., None], branches, 0.0))
    errors = reached.twist_to(Pose(poses.position[:, None], poses.rotation[:, None]))[closes]
    worst = float(np.abs(errors).max())
    count = closes.sum(axis=-1).mean()
    text = f'{worst:.1e} m or rad, {count:.1f} branches a pose'
    return Row(f'{name}: worst closure of all branches', text, '≤ 1e-9', worst <= 1e-9)
