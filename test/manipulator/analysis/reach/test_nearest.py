from dataclasses import replace

import numpy as np
import pytest

from hexapod_control.workspace import sample
from manipulator.analysis.free_paths import admits, is_connected
from manipulator.analysis.nearest import nearest_reachable
from manipulator.analysis.readings import displaced, distance
from manipulator.errors import InvalidInput
from manipulator.framed_machine import in_frames
from manipulator.frames import Frames
from manipulator.limits.constraints import Constraints
from manipulator.limits.machine_limits import JointRange
from manipulator.pose import Pose
from sampling import enough

TOLERANCE = 2e-5


def targets(machine, count, seed):
    generator = np.random.default_rng(seed)
    home, length = machine.kinematics.home, machine.kinematics.characteristic_length
    return displaced(machine, home, generator.standard_normal((count, 6)) * 0.5 * length)


def test_the_nearest_pose_keeps_all_limits_and_is_connected_to_home(machine):
    wanted = targets(machine, 6, 1)
    for k in range(6):
        found = nearest_reachable(machine, wanted[k])
        joints = machine.kinematics.inverse(found.pose)
        machine.constraints.check(found.pose, joints)
        assert is_connected(machine, found.pose)
        assert found.distance == pytest.approx(float(distance(machine, found.pose, wanted[k])))


def test_no_pose_found_by_random_search_is_nearer(platform):
    count = enough(4, 10)
    wanted = targets(platform, count, 2)
    generator = np.random.default_rng(3)
    length = platform.kinematics.characteristic_length
    everywhere = sample(platform, 300, generator)
    for k in range(count):
        found = nearest_reachable(platform, wanted[k])
        limit = found.distance - TOLERANCE
        assert distance(platform, everywhere, wanted[k]).min() > limit
        for radius in (3e-2, 1e-2, 1e-3, 1e-4, 1e-5):
            steps = generator.standard_normal((1000, 6)) * radius * length
            trials = displaced(platform, found.pose, steps)
            nearer = distance(platform, trials, wanted[k]) < limit
            assert not admits(platform, trials[nearer]).any()


def test_a_reachable_pose_is_its_own_nearest(machine):
    pose = displaced(machine, machine.kinematics.home, np.full(6, 1e-3))
    found = nearest_reachable(machine, pose)
    assert found.distance < 1e-9
    assert np.abs(found.pose.twist_to(pose)).max() < 1e-8


def test_beyond_the_end_of_an_axis_by_symmetry_the_platform_is_only_raised(robocake):
    """Straight above home, symmetry keeps the nearest pose on the axis: the end of z's range."""
    found = nearest_reachable(robocake, Pose.from_xyz_rpy([0, 0, 0.075]))
    assert found.pose.position[2] == pytest.approx(0.04119 + 17.910e-3, abs=2e-6)
    assert np.abs(found.pose.position[:2]).max() < 1e-6


def test_the_nearest_pose_is_that_of_the_pivot_in_the_work_frame(robocake):
    """A pivot above the platform: another place is nearest; turned work axes: the same one."""
    work = Pose.from_xyz_rpy([0.1, -0.2, 0.3], [0.2, 0.1, -0.7])
    raised = Frames(Pose.identity()).with_pivot([0.01, 0.0, 0.05])
    both = Frames(work).with_pivot([0.01, 0.0, 0.05])
    generator, length = np.random.default_rng(5), robocake.kinematics.characteristic_length
    wanted = targets(robocake, 3, 6)
    for target in (wanted[k] for k in range(3)):
        machine, turned = in_frames(robocake, raised), in_frames(robocake, both)
        found = nearest_reachable(machine, target)
        machine.constraints.check(found.pose, machine.kinematics.inverse(found.pose))
        steps = generator.standard_normal((2000, 6)) * 1e-3 * length
        trials = displaced(machine, found.pose, steps)
        nearer = distance(machine, trials, target) < found.distance - TOLERANCE
        assert not admits(machine, trials[nearer]).any()
        again = nearest_reachable(turned, work.inverse() @ target)
        assert again.distance == pytest.approx(found.distance, abs=TOLERANCE)


def test_limits_that_are_not_one_platforms_are_refused(robocake):
    free = JointRange(np.full(6, -9.0), np.full(6, 9.0), robocake.kinematics.joint_names)
    limits = Constraints((*robocake.constraints.limits, free))
    with pytest.raises(InvalidInput, match='limits of one platform'):
        nearest_reachable(replace(robocake, constraints=limits), Pose.from_xyz_rpy([0, 0, 0.075]))


def test_an_arm_stretches_towards_a_point_far_away(arm):
    """L2 + L3 + tool from the shoulder, 920 mm, turned as wanted: straight towards the target."""
    shoulder = np.array([0.0, 0.0, 0.3])
    far = shoulder + np.array([2.0, 0.0, 0.0])
    found = nearest_reachable(arm, Pose.from_xyz_rpy(far, [0, np.pi / 2, 0]))
    assert found.distance == pytest.approx(2.0 - 0.92, abs=1e-6)
    assert found.pose.position == pytest.approx(np.array([0.92, 0, 0.3]), abs=1e-3)
