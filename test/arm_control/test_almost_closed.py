"""The inverse of arms that were not quite built as drawn: all branches, exact, and quickly."""

import numpy as np
import pytest

from arm_control.arm import SerialArm
from arm_control.chain import Chain
from arm_control.identification.arm_model import ArmModel
from arm_control.numerical import AlmostClosed, Numerical
from branches import apart
from hexarm.machines import load
from manipulator.errors import Unreachable
from manipulator.pose import Pose
from sampling import enough

LENGTH, ANGLE = 5e-4, np.radians(1.0)


@pytest.fixture(params=['arm_6r', 'ur5', 'puma560'])
def arm(request):
    """The arm with every length and angle somewhere within half a millimetre and a degree."""
    drawn = load(request.param).kinematics
    model = ArmModel(drawn, LENGTH, ANGLE)
    largest = [parameter.tolerance for parameter in model.parameters]
    errors = largest * np.random.default_rng(3).uniform(-1.0, 1.0, len(largest))
    chain = model.identified(errors)
    return SerialArm(chain, drawn.limits, drawn.characteristic_length, drawn.rest)


def some_joints(arm, count):
    low, high = np.maximum(arm.limits.low, -np.pi), np.minimum(arm.limits.high, np.pi)
    return np.random.default_rng(4).uniform(low, high, (count, 6))


def test_the_joints_that_made_a_pose_are_among_its_branches(arm):
    assert isinstance(arm.method, AlmostClosed)
    joints = some_joints(arm, enough(300, 1000))
    branches = arm.method.branches(arm.chain.forward(joints), joints * 0.0 + arm.rest)
    assert apart(branches, joints[:, None]).min(axis=1).max() < 1e-4


def test_every_branch_leads_to_the_pose_and_none_stands_twice(arm):
    pose = arm.chain.forward(some_joints(arm, 1)[0])
    branches = arm.inverse_all(pose)
    found = branches[np.isfinite(branches[:, 0])]
    assert len(found) >= 2
    there = arm.chain.forward(found)
    assert max(np.abs(there[i].twist_to(pose)).max() for i in range(len(found))) < 1e-9
    for i, one in enumerate(found):
        assert (apart(np.delete(found, i, axis=0), one) > 1e-5).all()


def test_at_the_edge_where_the_drawn_arm_does_not_reach_it_still_does(arm):
    joints = some_joints(arm, enough(60, 200))
    joints[:, 2] = 0.0 if arm.limits.low[2] < 0.0 < arm.limits.high[2] else arm.rest[2]
    poses = arm.chain.forward(joints)
    out_of_drawn_reach = np.isnan(arm.method.ideal.branches(poses, joints)).all(axis=(-1, -2))
    for k in range(len(joints)):
        assert np.isfinite(arm.inverse_or_nan(poses[k], arm.rest)).all(), out_of_drawn_reach[k]


def test_out_of_reach_is_said_by_how_much(arm):
    far = Pose.from_xyz_rpy((3.0, 0.0, 0.3), (3.0, 0.0, 0.0))
    with pytest.raises(Unreachable, match=r'm from the shoulder, reach is \d'):
        arm.inverse(far)


def test_an_arm_of_another_build_is_left_to_the_numerical_method():
    drawn = load('arm_6r').kinematics
    axes = drawn.chain.axes.copy()
    axes[2] = [0.0, 1.0, 0.0]
    other = Chain(axes, drawn.chain.points, drawn.chain.home)
    assert isinstance(SerialArm(other, drawn.limits, 0.4, drawn.rest).method, Numerical)
