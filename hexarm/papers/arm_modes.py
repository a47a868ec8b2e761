"""The modes of Fadeev and Loginov that keep the gripper's orientation, as the nodes do them."""

from collections.abc import Iterator

import numpy as np

from arm_control.load import jogging
from arm_control.resolved_rate import JogState, ResolvedRate
from hexarm import machines
from hexarm.papers.arm_method import MACHINE, START, TICK, VELOCITY
from hexarm.papers.finding import ARM, Claim, Finding
from manipulator.arrays import Array
from manipulator.pose import Pose
from manipulator.teleop.jog_modes import Feedback
from manipulator.teleop.jogger import within_speed
from manipulator.teleop.modes import jog_mode

SIGHT = 0.35
MODE_TICKS = 300
KEPT = 1e-3
"""Degrees or millimetres within which a mode keeps what it is for."""
ROUNDING = 1e-6
REASON = 'closed loop on the pose, by the angular velocity: without false singularities'


def findings() -> Iterator[Finding]:
    """Each way of keeping the gripper's orientation, over three seconds of motion at 100 Hz."""
    jog = jogging(machines.read(MACHINE))
    start = jog.arm.chain.forward(START)
    point = start.position + SIGHT * start.rotation[:, 2]
    across, turning = sideways(), np.zeros(6)
    turning[5] = 0.2
    approach = np.sort(np.abs(_driven(jog, 'parallel', across)[-1].rotation[:, 2]))
    beside = float(np.arcsin(np.linalg.norm(approach[:2])))
    turned = _driven(jog, 'turn_base_z', turning)
    moved = max(float(np.linalg.norm(p.position - start.position)) for p in turned)
    looking = _driven(jog, 'look_at', across, point)
    sight = max(_off_sight(p, point) for p in looking)
    yield _kept('held', 'held constant', float(held_orientation().max()), '°')
    yield _kept('turned', 'turned about z, its point kept', 1e3 * moved, 'mm')
    yield _kept('parallel', 'parallel to an axis, at the end', float(np.degrees(beside)), '°')
    yield _kept('pointing', 'pointing at one point', float(np.degrees(sight)), '°')


def sideways() -> Array:
    """The twist of the motions in which the orientation is kept."""
    return np.concatenate([0.3 * VELOCITY, np.zeros(3)])


def held_orientation() -> Array:
    """How far the tool is turned at each tick while the mode holds its orientation, degrees."""
    jog = jogging(machines.read(MACHINE))
    first = Pose(np.zeros(3), jog.arm.chain.forward(START).rotation)
    poses = _driven(jog, 'hold_orientation', sideways())
    return np.degrees([np.linalg.norm(first.twist_to(pose)[3:]) for pose in poses])


def _kept(key: str, name: str, value: float, unit: str) -> Finding:
    space = ' ' if unit == 'mm' else ''
    return Finding(
        f'mode_{key}', ARM, f'orientation {name}', Claim('a mode', (0.0,), KEPT),
        f'deviates by ≤ {value:.1e}{space}{unit}', (value,), unit, 0.05 * value + ROUNDING, REASON,
    )  # fmt: skip


def _driven(
    jog: ResolvedRate, name: str, command: Array, point: Array | None = None
) -> list[Pose]:
    forward, state = jog.arm.chain.forward, JogState.at_rest(START)
    poses = [forward(START)]
    held = jog_mode(name, Feedback.for_delay(TICK), point).latched(poses[0])
    for _ in range(MODE_TICKS):
        twist, held = held.step(command, poses[-1], poses[-1].position)
        state = jog.step(state, within_speed(twist, jog.motion)[0], TICK).state
        poses.append(forward(state.joints))
    return poses


def _off_sight(pose: Pose, point: Array) -> float:
    sight = (point - pose.position) / np.linalg.norm(point - pose.position)
    sine = float(np.linalg.norm(np.cross(pose.rotation[:, 2], sight)))
    return float(np.arcsin(min(sine, 1.0)))
