"""What the jog modes keep over a metre, on drives of finite resolution and through a delay."""

from collections import deque

import numpy as np

from arm_control.load import jogging
from arm_control.resolved_rate import JogState, ResolvedRate
from bench.row import Row
from manipulator.arrays import Array
from manipulator.machine import MachineFile
from manipulator.pose import Pose
from manipulator.teleop.jog_modes import Feedback
from manipulator.teleop.jogger import within_speed
from manipulator.teleop.modes import jog_mode

TICK, DELAY_TICKS = 0.01, 4
STEPPER = np.full(6, 2 * np.pi / (3200 * 10))  # 3200 steps a turn, through a 10:1 gear
TILTED = np.radians([10.0, 20.0, 80.0, 20.0, 50.0, 0.0])
SIGHT = 0.35


def jog_rows(file: MachineFile) -> list[Row]:
    jog = jogging(file)
    per_degree = [joint['us_per_deg'] for joint in file.servos['joints'][:6]]
    hobby = np.radians(0.5 / np.array(per_degree))  # half a microsecond is a count on the wire
    found = []
    for drive, steps, goals in (
        ('steppers', STEPPER, (0.1, 0.5)),
        ('hobby servos, by their pulses alone', hobby, (np.inf, np.inf)),
    ):
        for name, value, unit, goal in held(jog, steps, goals):
            shown = f'≤ {goal}' if np.isfinite(goal) else ''
            label = f'arm_6r, {drive}: {name}'
            found.append(Row(label, f'{value:.3f} {unit}', shown, value <= goal))
    return found


def held(
    jog: ResolvedRate, steps: Array, goals: tuple[float, float]
) -> list[tuple[str, float, str, float]]:
    """Worst angles in degrees and distances in millimetres, with their goals."""
    start = jog.arm.chain.forward(TILTED)
    point = start.position + SIGHT * start.rotation[:, 2]
    metre = commands([0.2, 0, 0], 1.5) + commands([0, -0.15, 0.1], 1) + commands([-0.2, 0, 0], 2.5)
    turn = commands([0, 0, 0, 0, 0, 0.5], 1.5) + commands([0, 0, 0, 0, 0, -0.5], 3)
    kept = driven(jog, 'hold_orientation', steps, metre)
    turned = driven(jog, 'turn_base_z', steps, turn)
    looking = driven(jog, 'look_at', steps, metre, point)
    angle = max(np.linalg.norm(start.twist_to(pose)[3:]) for pose in kept)
    shift = max(np.linalg.norm(pose.position - start.position) for pose in turned)
    missed = max(np.linalg.norm(off_sight(pose, point)) for pose in looking)
    return [
        ('orientation kept over 1 m', np.degrees(angle), '°', goals[0]),
        ('tool point kept while turning', 1e3 * shift, 'mm', goals[1]),
        ('line of sight kept on a point over 1 m', np.degrees(missed), '°', goals[0]),
    ]


def commands(twist: list[float], seconds: float) -> list[Array]:
    return [np.array(twist + [0.0] * (6 - len(twist)))] * round(seconds / TICK)


def driven(
    jog: ResolvedRate, name: str, steps: Array, twists: list[Array], point: Array | None = None
) -> list[Pose]:
    """The poses of joints rounded to their steps; the mode sees them DELAY_TICKS late."""
    forward, state = jog.arm.chain.forward, JogState.at_rest(TILTED)
    poses = deque([forward(TILTED)] * (DELAY_TICKS + 1))
    held_mode = jog_mode(name, Feedback.for_delay(DELAY_TICKS * TICK), point).latched(poses[0])
    for command in twists:
        late, commanded = poses[-1 - DELAY_TICKS], forward(state.joints).position
        twist, held_mode = held_mode.step(command, late, commanded)
        state = jog.step(state, within_speed(twist, jog.motion)[0], TICK).state
        poses.append(forward(np.round(state.joints / steps) * steps))
    return list(poses)


def off_sight(pose: Pose, point: Array) -> Array:
    sight = (point - pose.position) / np.linalg.norm(point - pose.position)
    return np.cross(pose.rotation[:, 2], sight)
