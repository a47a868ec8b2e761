import numpy as np
import pytest

from manipulator.errors import InvalidInput, Refused
from manipulator.motion_limits import Derivatives, MotionLimits
from manipulator.pose import Pose
from manipulator.teleop.command_frames import in_base
from manipulator.teleop.speed_limits import within_speed

POSE = Pose.from_xyz_rpy([0.3, 0.1, 0.4], [0.0, 0.0, np.pi / 2])
COMMAND = np.array([0.1, 0.2, 0.3, 0.4, 0.5, 0.6])
MOTION = MotionLimits(Derivatives(0.2, 1.0), Derivatives(0.5, 1.0), Derivatives(1.0, 1.0))


def test_base_commands_stay_as_they_are():
    for frame in ('', 'base'):
        assert np.array_equal(in_base(COMMAND, frame, POSE), COMMAND)


def test_tool_commands_turn_with_the_tool():
    expected = [-0.2, 0.1, 0.3, -0.5, 0.4, 0.6]
    assert np.abs(in_base(COMMAND, 'tool', POSE) - expected).max() < 1e-12


def test_a_turn_about_the_pivot_leaves_the_pivot_where_it_is():
    pivot = np.array([0.5, -0.2, 0.1])
    turn = np.concatenate([np.zeros(3), COMMAND[3:]])
    twist = in_base(turn, 'pivot', POSE, pivot)
    fixed_in_tool = POSE.inverse().transform(pivot[None])
    moved = POSE.moved(1e-6 * twist).transform(fixed_in_tool)[0]
    assert np.abs(moved - pivot).max() < 1e-11


@pytest.mark.parametrize(('frame', 'reason'), [('world', 'not one of'), ('pivot', 'no pivot')])
def test_unknown_frames_and_missing_pivots_are_refused(frame, reason):
    with pytest.raises(Refused, match=reason):
        in_base(COMMAND, frame, POSE)


@pytest.mark.parametrize(
    ('twist', 'scale'),
    [
        ([0.1, 0, 0, 0, 0.4, 0], 1.0),
        ([0.4, 0, 0, 0, 0.4, 0], 0.5),
        ([0.1, 0, 0, 0, 0, 2.0], 0.25),
        ([0.12, 0.16, 0, 0.3, 0.4, 0], 1.0),
    ],
)
def test_twists_above_the_limits_are_scaled_as_a_whole(twist, scale):
    scaled, part = within_speed(np.array(twist), MOTION)
    assert part == pytest.approx(scale)
    assert np.allclose(scaled, scale * np.array(twist))


def test_twists_that_are_not_finite_are_refused():
    with pytest.raises(InvalidInput, match='not six finite'):
        within_speed(np.array([0, 0, np.inf, 0, 0, 0]), MOTION)
