"""Goals and paths that are points: the orientation is kept as a jog mode keeps it.

And moves by joints: motion linear in the legs of a platform.
"""

import numpy as np
import pytest

from manipulator.planning.goal import Goal, Motion
from manipulator.planning.orientation import Orientation
from manipulator.planning.path import Tolerance
from manipulator.planning.path_timing import PathRequest
from manipulator.pose import Pose
from manipulator.trajectory.path_planning import PathGoal

ARM = 'arm_6r_stepper'


def send(world, pose, orientation=Orientation.GIVEN, motion=Motion.LINE):
    """A goal as the node makes it; what became of it."""
    stamp, core = world.user.stamp, world.controller.core
    rule = core.orientation_rule(orientation, is_of_platform=True)
    goal = Goal(pose, stamp, motion=motion, orientation=rule)
    core.pursue(goal, lambda error: core.refuse(stamp, error), world.now)
    return world.end_of(stamp)


def send_path(world, positions, orientation):
    """A path of points; what became of it, and the true poses on the way."""
    stamp, core = world.user.stamp, world.controller.core
    rule = core.orientation_rule(orientation, is_of_platform=True)
    request = PathRequest(Pose(positions, np.eye(3)), 0.1, Tolerance())
    path = PathGoal(stamp, lambda: request, True, rule)
    core.follow(path, lambda error: core.refuse(stamp, error), world.now)
    poses = []
    world.wait('path', lambda: world.status.mode == 'path')
    while world.status.mode == 'path':
        world.run(0.01)
        poses.append(world.pose)
    return world.end_of(stamp), poses


def test_goals_in_a_row_that_are_points_hold_the_orientation(make_world):
    world = make_world(ARM)
    home = world.machine.kinematics.home
    for shift in ((0.1, 0.0, 0.0), (0.0, 0.1, 0.05), (-0.1, 0.0, 0.0)):
        point = Pose(home.position + np.array(shift), np.eye(3))
        assert send(world, point, Orientation.HOLD).result == 'reached'
        gap = world.pose.twist_to(Pose(point.position, home.rotation))
        assert np.linalg.norm(gap[:3]) < 5e-4
        assert np.linalg.norm(gap[3:]) < np.radians(0.1)


def test_a_path_of_points_looks_at_a_point_from_its_first_pose_to_its_last(make_world):
    world = make_world(ARM)
    home = world.machine.kinematics.home
    target = home.position + np.array([0.0, 0.05, -0.3])
    world.controller.teleop.look_at(target)
    ends = home.position + np.array([[-0.1, 0.0, 0.0], [0.1, 0.0, 0.0]])
    status, poses = send_path(world, ends, Orientation.LOOK_AT)
    assert status.result == 'reached'
    for pose in poses:
        sight = (target - pose.position) / np.linalg.norm(target - pose.position)
        assert np.linalg.norm(np.cross(pose.rotation[:, 2], sight)) < np.radians(0.2)


def test_looking_at_nothing_is_refused_and_the_next_goal_works(make_world):
    world = make_world(ARM)
    home = world.machine.kinematics.home
    point = Pose(home.position + np.array([0.05, 0.0, 0.0]), np.eye(3))
    stamp, core = world.user.stamp, world.controller.core
    rule = core.orientation_rule(Orientation.LOOK_AT, is_of_platform=True)
    with pytest.raises(ValueError, match='no point was given yet'):
        core.pursue(Goal(point, stamp, orientation=rule), lambda error: None, world.now)
    assert send(world, point, Orientation.HOLD).result == 'reached'


@pytest.mark.parametrize('name', ['stewart_6_6', 'stewart_6_3', 'robocake'])
def test_a_joint_move_of_a_platform_is_linear_in_its_legs(make_world, name):
    world = make_world(name)
    kinematics = world.machine.kinematics
    shift = 0.05 * kinematics.characteristic_length
    since = len(world.inverse.published)
    goal = kinematics.home.moved([shift, -shift, shift, 0.02, 0.02, 0.05])
    assert send(world, goal, motion=Motion.JOINT).result == 'reached'
    rows = np.array([joints for _, joints in world.inverse.published[since:]])
    way = rows[-1] - rows[0]
    share = (rows - rows[0]) @ way / (way @ way)
    assert np.abs(rows - rows[0] - share[:, None] * way).max() < 1e-5
    assert np.abs(world.pose.twist_to(goal)[:3]).max() < 5e-4
