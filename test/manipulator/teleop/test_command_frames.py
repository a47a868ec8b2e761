import numpy as np
import pytest

from manipulator.errors import InvalidInput, Refused
from manipulator.frames import Frames
from manipulator.motion_limits import Derivatives, JointDerivatives, MotionLimits
from manipulator.pose import Pose
from manipulator.teleop.jogger import in_work_axes, within_speed

POSE = Pose.from_xyz_rpy([0.3, 0.1, 0.4], [0.0, 0.0, np.pi / 2])
COMMAND = np.array([0.1, 0.2, 0.3, 0.4, 0.5, 0.6])
MOTION = MotionLimits(Derivatives(0.2, 1.0), Derivatives(0.5, 1.0), JointDerivatives.of(1.0, 1.0))
TURNED = Frames(T_base_work=Pose.from_xyz_rpy([0.1, 0.2, 0.3], [0.3, -0.2, 0.9]))


@pytest.mark.parametrize('frame', ['', 'base', 'work', 'pivot'])
def test_plain_frames_leave_commands_as_they_are(frame):
    assert np.array_equal(in_work_axes(COMMAND, frame, POSE, Frames()), COMMAND)


def test_tool_commands_turn_with_the_tool():
    expected = [-0.2, 0.1, 0.3, -0.5, 0.4, 0.6]
    assert np.abs(in_work_axes(COMMAND, 'tool', POSE, TURNED) - expected).max() < 1e-12


@pytest.mark.parametrize('frame', ['', 'base'])
def test_base_commands_move_along_base_axes_whatever_the_work_frame(frame):
    twist = in_work_axes(COMMAND, frame, POSE, TURNED)
    start, end = (TURNED.platform(p) for p in (POSE, POSE.moved(1e-6 * twist)))
    assert np.abs(start.twist_to(end) * 1e6 - COMMAND).max() < 1e-6


@pytest.mark.parametrize('frame', ['work', 'pivot'])
def test_work_commands_move_along_work_axes(frame):
    assert np.array_equal(in_work_axes(COMMAND, frame, POSE, TURNED), COMMAND)


def test_unknown_frames_are_refused_with_those_that_there_are():
    with pytest.raises(Refused, match="'moon' is not one of base, work, pivot, tool"):
        in_work_axes(COMMAND, 'moon', POSE, Frames())


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
