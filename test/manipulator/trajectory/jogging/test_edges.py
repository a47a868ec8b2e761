"""At an edge of what a machine can do a jog slides to a stop, and from beyond it leads back."""

import numpy as np
import pytest

from hexarm.machines import load
from manipulator.trajectory.goal import Goal
from sampling import enough


@pytest.mark.parametrize('seed', range(enough(2, 3)))
def test_platform_slides_to_a_stop_at_the_edge_and_is_driven_back(platform, at_home, seed):
    first, second = np.random.default_rng(seed).uniform(-1.0, 1.0, (2, 6))
    motion = at_home(platform)
    size = motion.full_speed
    outward = [size * d / np.abs(d).max() for d in (first, second)]
    for out in outward:
        motion.run_to_the_edge(out)
    motion.check_limits()
    # Backwards over the last edge, which may end at the first one, then away from that.
    motion.run_to_the_edge(-outward[1])
    edge = motion.state.pose
    back = motion.run(40, -outward[0])
    way = edge.twist_to(back[-1]) / size
    assert np.abs(way).max() > 0.01


def test_platform_keeps_its_direction_to_the_edge(platform, at_home):
    """Its position stays on the line and it turns about one axis, whatever holds it back."""
    rng = np.random.default_rng(6)
    for _ in range(4):
        motion, size = at_home(platform), platform.motion.linear.speed
        part = rng.uniform(-1.0, 1.0, 6)
        twist = motion.full_speed * part / np.abs(part).max()
        motion.run_to_the_edge(twist, frame='work')
        motion.run(10, twist, frame='work')
        assert np.linalg.norm(motion.twists, axis=1).max() > 0.1 * size
        away = np.array([motion.poses[0].twist_to(pose) for pose in motion.poses])
        for way, wanted, bound in (
            (away[:, :3], twist[:3], 2e-3),
            (away[:, 3:], twist[3:], np.radians(1.0)),
        ):
            axis = wanted / np.linalg.norm(wanted)
            assert np.linalg.norm(way - np.outer(way @ axis, axis), axis=1).max() < bound
        progress = away[:, :3] @ twist[:3] / (twist[:3] @ twist[:3])
        turned = away[:, 3:] @ twist[3:] / (twist[3:] @ twist[3:])
        assert np.abs(progress - turned).max() < 1e-9


def test_arm_at_the_edge_of_its_reach_stops_and_names_the_singularity(standing):
    machine = load('arm_6r')
    home = machine.kinematics.home
    motion = standing(machine, home, machine.kinematics.inverse(home))
    motion.run(450, [0, 0.2, 0, 0, 0, 0])
    assert motion.status.reason == 'scaled to 0: elbow singularity (arm stretched or folded)'
    assert np.abs(motion.poses[-1].twist_to(motion.poses[-2])).max() == 0.0
    assert np.abs(home.twist_to(motion.poses[-1])[[0, 2, 3, 4, 5]]).max() < 1e-3
    motion.run(100, [0, -0.2, 0, 0, 0, 0])
    assert motion.poses[450].position[1] - motion.poses[-1].position[1] > 0.02


def test_arm_beyond_its_range_moves_only_towards_it(standing):
    machine = load('arm_6r')
    beyond = np.radians([0.0, 20.0, 80.0, 0.0, 125.0, 0.0])
    pose = machine.kinematics.forward(beyond).pose
    motion = standing(machine, pose, beyond)
    motion.pursue(Goal(machine.kinematics.home, 1.0))
    motion.run(500)
    assert motion.status.result == 'reached'
    assert np.array(motion.configurations)[:, 4].max() <= beyond[4] + 1e-6
    for sign in (1, -1):
        motion = standing(machine, pose, beyond)
        motion.run(100, [0, 0, 0, 0.5 * sign, 0, 0])
        assert np.array(motion.configurations)[:, 4].max() <= beyond[4] + 1e-6


@pytest.mark.parametrize('platform', ['stewart_6_3', 'stewart_6_3 in frames'], indirect=True)
def test_platform_beyond_a_limit_is_driven_back_but_not_further(platform, at_home, standing):
    motion = at_home(platform)
    up = [0, 0, 1, 0, 0, 0] * np.array(platform.motion.linear.speed)
    motion.run_to_the_edge(up)
    motion.run(30)
    pose = motion.state.pose.moved([0, 0, 1e-5, 0, 0, 0])
    joints = platform.kinematics.inverse_or_nan(pose, motion.joints)
    assert not platform.constraints.admits(pose, joints)
    beyond = standing(platform, pose, joints)
    assert beyond.run(20, up)[-1].position[2] <= pose.position[2] + 1e-9
    assert beyond.run(50, -up)[-1].position[2] < pose.position[2] - 1e-4
