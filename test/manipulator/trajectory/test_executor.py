"""The executor against the RoboCake: what it commands is checked by its own differences."""

import contextlib
import itertools
import re
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hexarm.machines import load
from manipulator.errors import Refused, Unreachable
from manipulator.planning.cycle import Cycle
from manipulator.planning.goal import Goal
from manipulator.pose import Pose
from manipulator.trajectory.executor import Executor
from manipulator.trajectory.motion_status import MotionStatus

MACHINE = load('robocake')
HOME = MACHINE.kinematics.home
DT = 0.01


def executor():
    return Executor(MACHINE, HOME, MACHINE.kinematics.inverse(HOME), DT)


def pose(x=0.0, y=0.0, z=0.0412, roll=0.0, pitch=0.0, yaw=0.0):
    return Pose.from_xyz_rpy((x, y, z), (roll, pitch, yaw))


def run(motion, ticks):
    poses, joints = [motion.state.pose], [motion.joints]
    for _ in range(ticks):
        poses.append(motion.step())
        joints.append(motion.joints)
    return poses, np.array(joints)


def check_limits(poses, joints):
    speed = np.abs(np.diff(joints, axis=0)).max() / DT
    assert speed <= 1.01 * MACHINE.motion.joint.speed
    acceleration = np.abs(np.diff(joints, n=2, axis=0)).max(initial=0.0) / DT**2
    assert acceleration <= 1.01 * MACHINE.motion.joint.acceleration
    twists = np.array([a.twist_to(b) for a, b in itertools.pairwise(poses)]) / DT
    assert np.linalg.norm(twists[:, :3], axis=1).max() <= 1.01 * MACHINE.motion.linear.speed
    assert np.linalg.norm(twists[:, 3:], axis=1).max() <= 1.01 * MACHINE.motion.angular.speed
    if len(poses) > 2:
        change = np.diff(twists[:, :3], axis=0) / DT
        assert np.linalg.norm(change, axis=1).max() <= 1.01 * MACHINE.motion.linear.acceleration
    for p, q in zip(poses, joints, strict=True):
        MACHINE.constraints.check(p, q)


def test_it_begins_by_holding_and_names_no_goal():
    motion = executor()
    assert motion.status == MotionStatus('hold', 'idle', 0.0, '', None)
    assert motion.newest_stamp == 0.0
    motion.stop()
    assert motion.status == MotionStatus('hold', 'stopped', 0.0)


class Failing:
    """The kinematics of a machine, which find no joints while `is_failing`."""

    is_failing = False

    def __init__(self, inner):
        self._inner = inner

    def __getattr__(self, name):
        return getattr(self._inner, name)

    def inverse(self, pose, near=None):
        if self.is_failing:
            raise Unreachable('leg 2: rod too short', 2)
        return self._inner.inverse(pose, near)


def test_a_pose_without_joints_ends_the_motion_at_the_last_command_that_had_some():
    """The check of a plan finds such poses; one that it has missed must not move anything."""
    kinematics = Failing(MACHINE.kinematics)
    machine = replace(MACHINE, kinematics=kinematics)
    motion = Executor(machine, HOME, kinematics.inverse(HOME), DT)
    motion.pursue(Goal(pose(x=0.005), 12.5))
    poses, joints = run(motion, 15)
    kinematics.is_failing = True
    held = [motion.step() for _ in range(3)]
    assert max(np.abs(one.twist_to(poses[-1])).max() for one in held) < 1e-12
    assert (motion.joints == joints[-1]).all()
    assert motion.status == MotionStatus('hold', 'stopped', 12.5, 'leg 2: rod too short')
    kinematics.is_failing = False
    motion.pursue(Goal(HOME, 13.0))
    run(motion, 100)
    assert (motion.status.result, motion.status.goal_stamp) == ('reached', 13.0)


def test_goal_is_reached_and_named_by_its_stamp():
    motion = executor()
    motion.pursue(Goal(pose(x=0.005, z=0.045), 12.5))
    poses, joints = run(motion, 100)
    assert (motion.status.result, motion.status.goal_stamp) == ('reached', 12.5)
    assert np.abs(poses[-1].position - [0.005, 0.0, 0.045]).max() < 1e-9
    check_limits(poses, joints)


def test_unreachable_goal_is_refused_with_the_leg_and_the_old_one_goes_on():
    motion = executor()
    motion.pursue(Goal(pose(x=0.01), 1.0))
    run(motion, 10)
    motion.pursue(Goal(pose(x=0.04), 2.0))
    run(motion, 1)
    assert (motion.status.result, motion.status.goal_stamp) == ('refused', 2.0)
    assert 'leg' in motion.status.reason
    assert 'mm' in motion.status.reason
    run(motion, 100)
    assert (motion.status.result, motion.status.goal_stamp) == ('reached', 1.0)
    assert motion.state.pose.position[0] == pytest.approx(0.01)


def test_good_goal_after_a_refused_one_is_driven():
    motion = executor()
    motion.pursue(Goal(pose(z=0.2), 1.0))
    run(motion, 1)
    motion.pursue(Goal(pose(z=0.045), 2.0))
    run(motion, 100)
    assert (motion.status.result, motion.status.goal_stamp) == ('reached', 2.0)


def test_of_many_goals_within_a_tick_the_newest_wins():
    motion = executor()
    for k in range(20):
        motion.pursue(Goal(pose(x=0.0005 * k), float(k)))
    run(motion, 100)
    assert motion.status.goal_stamp == 19.0
    assert motion.state.pose.position[0] == pytest.approx(0.0095)


def test_stop_brakes_along_the_straight_path_and_holds():
    motion = executor()
    motion.pursue(Goal(pose(x=0.012, y=0.006), 1.0))
    run(motion, 15)
    motion.stop()
    poses, joints = run(motion, 30)
    assert motion.status.result == 'stopped'
    moved = np.linalg.norm(poses[-1].position - poses[-10].position)
    assert moved == 0.0
    assert poses[-1].position[0] < 0.011
    for p in poses:
        assert p.position[1] == pytest.approx(p.position[0] / 2, abs=1e-9)
    check_limits(poses, joints)


def test_goal_that_comes_while_stopping_is_driven_afterwards():
    motion = executor()
    motion.pursue(Goal(pose(x=0.012), 1.0))
    run(motion, 15)
    motion.stop()
    motion.pursue(Goal(pose(y=0.005), 2.0))
    poses, joints = run(motion, 150)
    assert (motion.status.result, motion.status.goal_stamp) == ('reached', 2.0)
    check_limits(poses, joints)


def test_pause_and_going_on_end_at_the_goal_without_a_jump():
    motion = executor()
    motion.pursue(Goal(pose(x=0.01, yaw=0.05), 1.0))
    before = run(motion, 15)
    motion.pause(True)
    during = run(motion, 40)
    assert np.abs(np.diff(during[1][-10:], axis=0)).max() == 0.0
    assert motion.status.result == 'moving'
    motion.pause(False)
    after = run(motion, 200)
    assert motion.status.result == 'reached'
    check_limits(
        before[0] + during[0][1:] + after[0][1:],
        np.vstack([before[1], during[1][1:], after[1][1:]]),
    )


def test_speed_override_makes_the_same_path_slower():
    fast, slow = executor(), executor()
    slow.override(0.25)
    ticks = []
    for motion in (fast, slow):
        motion.pursue(Goal(pose(x=0.01), 1.0))
        count = 0
        while motion.status.result != 'reached':
            motion.step()
            count += 1
        ticks.append(count)
    assert ticks[1] > 3 * ticks[0]


@pytest.mark.parametrize('rate', [-0.1, 1.1, float('nan')])
def test_override_outside_its_range_is_refused(rate):
    with pytest.raises(Refused, match='override'):
        executor().override(rate)


def test_cycle_ramps_in_and_out_within_the_limits():
    motion = executor()
    motion.start_cycle(
        Cycle(HOME, [0.003, 0.003, 0.0015, 0.05, 0.05, 0.04], [0.5] * 6, [0, 1, 2, 0, 1, 2])
    )
    poses, joints = run(motion, 500)
    assert motion.status.mode == 'cycle'
    assert np.ptp([p.position[0] for p in poses[-200:]]) == pytest.approx(0.006, rel=0.01)
    motion.stop()
    more = run(motion, 100)
    assert (motion.status.mode, motion.status.result) == ('hold', 'stopped')
    check_limits(poses + more[0][1:], np.vstack([joints, more[1][1:]]))


def test_papers_own_amplitudes_in_phase_are_out_of_reach_and_refused_before_anything_moves():
    motion = executor()
    motion.start_cycle(Cycle(HOME, [0.006, 0.006, 0.003, 0.1, 0.1, -0.08], [0.5] * 6, [0] * 6))
    poses, _ = run(motion, 10)
    assert motion.status.result == 'refused'
    assert re.match(r'\d\.\d+ s into the cycle: leg \d', motion.status.reason)
    assert np.abs(poses[-1].position - HOME.position).max() == 0.0


def test_cycle_that_is_too_fast_reports_by_how_much():
    motion = executor()
    motion.start_cycle(Cycle(HOME, [0.005, 0, 0, 0, 0, 0], [10.0] * 6, [0] * 6))
    run(motion, 1)
    assert motion.status.result == 'refused'
    assert 'times too fast' in motion.status.reason


coordinates = st.tuples(*([st.floats(-0.02, 0.02)] * 2), st.floats(0.02, 0.06))
turns = st.tuples(*([st.floats(-0.3, 0.3)] * 3))
commands = st.one_of(
    st.tuples(st.just('goal'), coordinates, turns),
    st.tuples(st.just('stop')),
    st.tuples(st.just('pause'), st.booleans()),
    st.tuples(st.just('override'), st.floats(0.0, 1.0)),
    st.tuples(st.just('cycle')),
)


@settings(max_examples=25, deadline=None)
@given(st.lists(st.tuples(commands, st.integers(1, 40)), min_size=1, max_size=12))
def test_no_stream_of_commands_leaves_the_limits(stream):
    motion, stamp = executor(), 0.0
    all_poses, all_joints = [motion.state.pose], [motion.joints]
    for command, ticks in stream:
        match command:
            case ('goal', xyz, rpy):
                stamp += 1.0
                motion.pursue(Goal(Pose.from_xyz_rpy(xyz, rpy), stamp))
            case ('stop',):
                motion.stop()
            case ('pause', is_paused):
                motion.pause(is_paused)
            case ('override', rate):
                motion.override(rate)
            case ('cycle',):
                amplitude = [0.002, 0.002, 0.001, 0.03, 0.03, 0.02]
                centre = motion.state.pose
                with contextlib.suppress(Refused, Unreachable):
                    motion.start_cycle(Cycle(centre, amplitude, [0.5] * 6, [0.5] * 6))
        poses, joints = run(motion, ticks)
        all_poses += poses[1:]
        all_joints += list(joints[1:])
    check_limits(all_poses, np.array(all_joints))
