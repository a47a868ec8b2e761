"""The jog modes driven on the paper's arm by perfect steppers, over a metre, through a delay."""

from collections import deque

import numpy as np
import pytest

from arm_control.load import jogging
from arm_control.resolved_rate import JogState
from manipulator.teleop.jog_modes import Feedback
from manipulator.teleop.jogger import within_speed
from manipulator.teleop.modes import jog_mode

STEP = 2 * np.pi / (3200 * 10)  # 3200 steps a turn, through a 10:1 gear
DT = 0.01
DELAY_TICKS = 4
HELD_ANGLE = np.radians(0.1)
HELD_POINT = 0.5e-3


@pytest.fixture(scope='module')
def paper_jog(machine_file):
    return jogging(machine_file('arm_6r'))


TILTED = np.radians([10.0, 20.0, 80.0, 20.0, 50.0, 0.0])


def driven(jog, name, joints, commands, point=None):
    """Measured poses, every tick, while the mode `name` follows `commands`."""
    mode = jog_mode(name, Feedback.for_delay(DELAY_TICKS * DT), point)
    state = JogState.at_rest(joints)
    forward = jog.arm.chain.forward
    poses = deque([forward(joints)] * (DELAY_TICKS + 1))
    held = mode.latched(poses[0])
    for command in commands:
        late = poses[-1 - DELAY_TICKS]
        twist, held = held.step(np.asarray(command), late, forward(state.joints).position)
        twist, _ = within_speed(twist, jog.motion)
        state = jog.step(state, twist, DT).state
        poses.append(forward(np.round(state.joints / STEP) * STEP))
    return list(poses)[DELAY_TICKS:]


def travelled(poses):
    positions = np.array([pose.position for pose in poses])
    return np.linalg.norm(np.diff(positions, axis=0), axis=1).sum()


def angle_between(a, b):
    return np.linalg.norm(a.twist_to(b)[3:])


def ticks(command, seconds):
    return [np.array(command, dtype=float)] * round(seconds / DT)


ROUND_TRIP = (
    ticks([0.2, 0, 0, 0, 0, 0], 1.5)
    + ticks([0, -0.15, 0.1, 0, 0, 0], 1.0)
    + ticks([-0.2, 0, 0.05, 0, 0, 0], 2.5)
    + ticks([0, 0.15, -0.15, 0, 0, 0], 1.0)
)


def test_orientation_is_held_while_translating_a_metre(paper_jog):
    poses = driven(paper_jog, 'hold_orientation', TILTED, ROUND_TRIP)
    assert travelled(poses) > 1.0
    assert max(angle_between(poses[0], pose) for pose in poses) < HELD_ANGLE


def test_a_command_to_turn_does_not_turn_a_held_orientation(paper_jog):
    commands = ticks([0.1, 0, 0, 0.5, 0.5, 0.5], 1.0)
    poses = driven(paper_jog, 'hold_orientation', paper_jog.arm.rest, commands)
    assert max(angle_between(poses[0], pose) for pose in poses) < HELD_ANGLE


@pytest.mark.parametrize('name', [f'turn_{f}_{a}' for f in ('base', 'tool') for a in 'xyz'])
def test_the_tool_point_stands_while_the_tool_turns(paper_jog, name):
    start = paper_jog.arm.chain.forward(TILTED)
    unit = np.eye(3)['xyz'.index(name[-1])]
    axis = unit if 'base' in name else start.rotation @ unit
    turns = [np.concatenate([[0.1, 0.1, 0.1], rate * axis]) for rate in [0.5] * 100 + [-0.5] * 100]
    poses = driven(paper_jog, name, TILTED, turns)
    assert max(np.linalg.norm(p.position - start.position) for p in poses) < HELD_POINT
    turned = poses[100].rotation @ start.rotation.T
    assert np.abs(turned @ axis - axis).max() < HELD_ANGLE
    assert angle_between(start, poses[100]) > 0.3


def test_the_tool_comes_parallel_to_the_nearest_axis_and_stays(paper_jog):
    joints = paper_jog.arm.rest + np.radians([0, 0, 0, 0, 8.0, 0])
    poses = driven(paper_jog, 'parallel', joints, ticks([0] * 6, 2.0) + ROUND_TRIP)
    tilts = [np.arccos(np.clip(-pose.rotation[2, 2], -1, 1)) for pose in poses]
    assert tilts[0] > np.radians(7)
    assert max(tilts[200:]) < HELD_ANGLE
    assert travelled(poses[200:]) > 1.0


def off_sight(pose, point):
    sight = (point - pose.position) / np.linalg.norm(point - pose.position)
    return np.arccos(np.clip(pose.rotation[:, 2] @ sight, -1, 1))


def test_the_tool_keeps_looking_at_the_point_along_a_metre(paper_jog):
    start = paper_jog.arm.chain.forward(TILTED)
    point = start.position + 0.35 * start.rotation[:, 2]
    poses = driven(paper_jog, 'look_at', TILTED, ROUND_TRIP, point)
    assert travelled(poses) > 1.0
    assert max(off_sight(pose, point) for pose in poses) < HELD_ANGLE


def test_orbiting_keeps_the_sight_and_the_distance(paper_jog):
    start = paper_jog.arm.home
    point = start.position + 0.3 * start.rotation[:, 2]
    orbit = ticks([0, 0, 0, 0.3, 0.2, 0], 2.0) + ticks([0, 0, 0, -0.3, -0.2, 0.1], 4.0)
    poses = driven(paper_jog, 'look_at', paper_jog.arm.rest, orbit, point)
    assert travelled(poses) > 0.5
    assert max(off_sight(pose, point) for pose in poses) < HELD_ANGLE
    distances = [np.linalg.norm(pose.position - point) for pose in poses]
    assert np.ptp(distances) < HELD_POINT


def test_even_without_a_loop_integration_loses_hardly_any_orientation(paper_jog):
    """By the Jacobian midway through each tick; at its beginning the loss would be 0.15°."""
    poses = driven(paper_jog, 'free', TILTED, ROUND_TRIP)
    assert max(angle_between(poses[0], pose) for pose in poses) < 0.3 * HELD_ANGLE


def test_the_tool_stops_short_of_the_point_it_looks_at(paper_jog):
    start = paper_jog.arm.home
    point = start.position + 0.1 * start.rotation[:, 2]
    down = ticks([0, 0, -0.1, 0, 0, 0], 4)
    poses = driven(paper_jog, 'look_at', paper_jog.arm.rest, down, point)
    distances = [np.linalg.norm(pose.position - point) for pose in poses]
    assert min(distances) > 0.0199
    assert distances[-1] < 0.025
