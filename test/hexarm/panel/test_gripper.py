"""The gripper of the page: its opening, and the fingers that show it."""

import numpy as np
import pytest

from hexarm.machines import load
from hexarm.panel.gripper import GripperJoint, fingers, gripper_of
from hexarm.panel.pieces import pieces
from manipulator.pose import Pose


@pytest.mark.parametrize(('closed', 'opened'), [(-0.9, 0.9), (0.9, -0.9)])
def test_the_opening_is_the_share_of_the_range_and_stays_within(closed, opened):
    joint = GripperJoint('gripper', closed, opened)
    assert [joint.opening(p) for p in (closed, 0.0, opened)] == [0.0, 0.5, 1.0]
    assert joint.opening(2 * closed) == 0.0
    assert joint.opening(2 * opened) == 1.0


@pytest.mark.parametrize('name', ['arm_6r', 'ur5', 'puma560'])
def test_arms_have_a_gripper(name):
    assert gripper_of(name) == GripperJoint(
        'gripper', pytest.approx(np.radians(-50)), pytest.approx(np.radians(50))
    )


def test_a_platform_has_none():
    assert gripper_of('robocake') is None


def test_the_fingers_part_and_hold_the_tool_point_between_their_tips():
    tool = Pose.from_xyz_rpy((0.1, 0.2, 0.3), (0.3, -0.4, 2.0))
    gaps = []
    for opening in (0.0, 1.0):
        (stroke,) = fingers(tool, opening, 1.2)
        left, *_, right = tool.inverse().transform(stroke.points)
        np.testing.assert_allclose(left + right, [0.0, 0.0, 2 * left[2]], atol=1e-12)
        gaps.append(right[0] - left[0])
    assert 0.0 < gaps[0] < gaps[1]


def test_it_has_bars_and_balls_like_other_parts():
    kinematics = load('arm_6r').kinematics
    strokes = kinematics.skeleton(kinematics.home, kinematics.inverse(kinematics.home))
    found = pieces(strokes + fingers(kinematics.home, 0.5, 1.2))
    assert found.parts.count('gripper') == 3
    assert len(found.balls) == len(found.ball_owners)
