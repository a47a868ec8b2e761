import numpy as np
import pytest

from manipulator.errors import Refused
from manipulator.pose import Pose
from manipulator.teleop.jog_modes import Feedback
from manipulator.teleop.modes import MODES, NEAREST, jog_mode

FEEDBACK = Feedback(5.0)
POSE = Pose.from_xyz_rpy([0.3, 0.1, 0.4], [0.1, -0.2, 0.3])
POINT = POSE.position + 0.3 * POSE.rotation[:, 2]
COMMAND = np.array([0.1, -0.05, 0.02, 0.3, -0.2, 0.1])


@pytest.mark.parametrize('name', [name for name in MODES if name != 'parallel'])
def test_without_command_a_latched_mode_stands(name):
    twist, _ = jog_mode(name, FEEDBACK, POINT).latched(POSE).step(np.zeros(6), POSE, POSE.position)
    assert np.abs(twist).max() < 1e-7


@pytest.mark.parametrize('name', MODES)
def test_stepping_changes_no_mode(name):
    held = jog_mode(name, FEEDBACK, POINT).latched(POSE)
    first, _ = held.step(COMMAND, POSE, POSE.position)
    held.step(-COMMAND, POSE.moved(0.1 * COMMAND), POSE.moved(0.1 * COMMAND).position)
    again, _ = held.step(COMMAND, POSE, POSE.position)
    assert np.array_equal(first, again)


@pytest.mark.parametrize('name', [name for name in MODES if name != 'free'])
def test_a_disturbance_dies_out(name):
    held = jog_mode(name, FEEDBACK, POINT).latched(POSE)
    pose = POSE.moved([0.01, -0.01, 0.02, 0.05, -0.04, 0.06])
    for _ in range(300):
        twist, held = held.step(np.zeros(6), pose, pose.position)
        pose = pose.moved(0.01 * twist)
    assert np.abs(held.step(np.zeros(6), pose, pose.position)[0]).max() < 1e-4


def test_free_drives_the_command():
    twist, _ = jog_mode('free', FEEDBACK).latched(POSE).step(COMMAND, POSE, POSE.position)
    assert np.array_equal(twist, COMMAND)


def test_parallel_chooses_the_nearest_of_six_directions():
    for axis in range(3):
        for sign in (1.0, -1.0):
            pose = Pose(POSE.position, _with_approach(sign * np.eye(3)[axis]))
            tilted = pose.moved([0, 0, 0, 0.1, 0.15, -0.1])
            held = jog_mode('parallel', FEEDBACK).latched(tilted)
            assert np.allclose(held.direction, sign * np.eye(3)[axis])


def _with_approach(direction):
    side = np.roll(direction, 1)
    return np.stack([side, np.cross(direction, side), direction], axis=1)


def test_look_at_is_fed_forward_so_that_the_sight_follows_at_once():
    held = jog_mode('look_at', FEEDBACK, POINT).latched(POSE)
    for command in (COMMAND, [0.1, 0, 0, 0, 0, 0], [0, 0, 0, 0.5, 0.2, -0.1]):
        twist, _ = held.step(np.array(command), POSE, POSE.position)
        moved = POSE.moved(1e-6 * twist)
        sight = (POINT - moved.position) / np.linalg.norm(POINT - moved.position)
        assert np.abs(moved.rotation[:, 2] - sight).max() < 1e-11


def test_look_at_orbits_with_the_turn_as_commanded():
    held = jog_mode('look_at', FEEDBACK, POINT).latched(POSE)
    across = POSE.rotation[:, 0]
    twist, _ = held.step(np.concatenate([np.zeros(3), 0.5 * across]), POSE, POSE.position)
    assert np.abs(twist[3:] - 0.5 * across).max() < 1e-9
    assert np.linalg.norm(twist[:3]) == pytest.approx(0.5 * 0.3)


def test_look_at_holds_the_distance_at_which_translation_ended():
    held, pose = jog_mode('look_at', FEEDBACK, POINT).latched(POSE), POSE
    back_off = np.concatenate([-0.1 * POSE.rotation[:, 2], np.zeros(3)])
    for _ in range(100):
        twist, held = held.step(back_off, pose, pose.position)
        pose = pose.moved(0.01 * twist)
    assert held.distance == pytest.approx(0.4, abs=2e-3)
    twist, held = held.step(np.zeros(6), pose, pose.position)
    assert np.linalg.norm(twist) < 0.01


def test_look_at_rolls_about_the_sight():
    held = jog_mode('look_at', FEEDBACK, POINT).latched(POSE)
    along = POSE.rotation[:, 2]
    twist, _ = held.step(np.concatenate([np.zeros(3), 0.5 * along]), POSE, POSE.position)
    assert np.abs(twist - np.concatenate([np.zeros(3), 0.5 * along])).max() < 1e-9


def test_a_point_on_the_tool_is_refused():
    near = POSE.position + 0.9 * NEAREST * np.eye(3)[2]
    with pytest.raises(Refused, match=r'0\.018 m from the tool, needs at least 0\.02 m'):
        jog_mode('look_at', FEEDBACK, near).latched(POSE)


def test_look_at_without_a_point_is_refused():
    with pytest.raises(Refused, match='no point was given'):
        jog_mode('look_at', FEEDBACK)


def test_an_unknown_mode_is_refused_with_the_nearest_name():
    with pytest.raises(Refused, match="did you mean 'look_at'"):
        jog_mode('look', FEEDBACK)
