"""At an edge of what a machine can do a jog slides to a stop, and from beyond it leads back."""

from dataclasses import replace

import numpy as np
import pytest

from hexarm.machines import load
from manipulator.errors import InvalidInput
from manipulator.framed_machine import in_frames
from manipulator.frames import Frames
from manipulator.limits.constraints import Constraints
from manipulator.limits.machine_limits import JointRange
from manipulator.planning.goal import Goal
from manipulator.pose import Pose
from manipulator.teleop.jogger import JogMotion, ticks_for, within_speed
from sampling import enough

DT = 0.01
TURNED = Frames(Pose.from_xyz_rpy([0.1, -0.2, 0.3], [0.2, 0.1, -0.7])).with_pivot([0.01, 0, 0.05])


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


@pytest.mark.parametrize('frames', [Frames(), TURNED])
def test_what_is_driven_could_be_braked_by_the_limits_own_words(frames):
    """Every tick of braking straight ahead, by poses, joints and their differences."""
    machine = in_frames(load('robocake'), frames)
    kinematics, motion = machine.kinematics, machine.motion
    jogger, rng = machine.make_jogger(machine), np.random.default_rng(7)
    at = JogMotion.at_rest(kinematics.home, kinematics.inverse(kinematics.home))
    driven = 0
    for tick in range(300):
        if tick % 60 == 0:
            twist = rng.standard_normal(6) * ([motion.linear.speed] * 3 + [0.3] * 3)
        before, at = at, jogger.step(at, within_speed(twist, motion)[0], DT)
        driven += at.scale > 0.0
        ticks = int(np.ceil(ticks_for(at.twist, motion, DT) - 1e-9))
        joints, rates, gone = before.joints, before.rates, 0.0
        for k in range(ticks + 1):
            gone += 1.0 - k / max(ticks, 1)
            pose = before.pose.moved(gone * DT * at.twist)
            now = kinematics.inverse(pose, before.joints)
            machine.constraints.check(pose, now)
            assert np.abs(now - joints).max() <= motion.joint.speed.max() * DT * (1 + 1e-9)
            change = ((now - joints) / DT - rates) / DT
            if at.scale > 0.0:
                assert (np.abs(change) <= motion.joint.acceleration * (1 + 1e-6)).all()
            joints, rates = now, (now - joints) / DT
    assert driven > 50


def test_limits_that_are_not_one_platforms_cannot_be_jogged_in():
    machine = load('robocake')
    free = JointRange(np.full(6, -9.0), np.full(6, 9.0), machine.kinematics.joint_names)
    limits = Constraints((*machine.constraints.limits, free))
    with pytest.raises(InvalidInput, match='one platform'):
        machine.make_jogger(replace(machine, constraints=limits))
