import numpy as np
import pytest

from manipulator.analysis.free_paths import admits
from manipulator.analysis.travel import travel
from manipulator.errors import InvalidInput
from manipulator.pose import Pose


@pytest.mark.parametrize('axis', range(6))
def test_travel_from_home_ends_where_the_axis_does(platform, axis):
    twist = np.zeros(6)
    twist[axis] = 0.5
    length = platform.kinematics.characteristic_length
    left = travel(platform, platform.kinematics.home, twist)
    end = left.seconds * twist
    on_the_way = platform.kinematics.home.moved(np.linspace(0.0, 1.0 - 1e-6, 200)[:, None] * end)
    assert admits(platform, on_the_way).all()
    assert not admits(platform, platform.kinematics.home.moved((1.0 + 1e-6) * end))
    assert left.metres == pytest.approx(end[axis] * (1.0 if axis < 3 else length))


def test_travel_names_the_limit_that_ends_it(robocake):
    home = robocake.kinematics.home
    assert 'platform height' in travel(robocake, home, np.array([0, 0, -0.01, 0, 0, 0])).reason
    assert 'rod too' in travel(robocake, home, np.array([0.01, 0, 0, 0, 0, 0])).reason


def test_the_end_is_the_last_pose_admitted(machine):
    home = machine.kinematics.home
    twist = np.array([0.02, 0.01, 0.01, 0.1, -0.1, 0.1])
    left = travel(machine, home, twist)
    ends = [home.moved(twist * (left.seconds + late)) for late in (-1e-6, 1e-6)]
    poses = Pose(np.stack([e.position for e in ends]), np.stack([e.rotation for e in ends]))
    joints = machine.kinematics.inverse(home)
    way = home.moved(twist * np.linspace(0, left.seconds - 1e-6, 200)[:, None])
    assert admits(machine, way, joints).all()
    assert not admits(machine, poses[1:], joints)[0]


def test_there_is_no_travel_from_out_of_reach(machine):
    pose = machine.kinematics.home.moved([5.0, 0, 0, 0, 0, 0])
    left = travel(machine, pose, np.array([-1.0, 0, 0, 0, 0, 0]))
    assert left.metres == 0.0
    assert left.reason


def test_a_turn_that_meets_no_limit_ends_at_half_a_turn(arm):
    left = travel(arm, arm.kinematics.home, np.array([0, 0, 0, 0, 0, 1.0]))
    assert left.seconds <= np.pi + 1e-9


@pytest.mark.parametrize('bad', [np.zeros(6), np.full(6, np.nan), np.ones(5)])
def test_a_twist_that_leads_nowhere_is_refused(robocake, bad):
    with pytest.raises(InvalidInput):
        travel(robocake, robocake.kinematics.home, bad)
