"""Joint moves by definition: straight in the joints, within every limit, at the pose they say."""

import re
from dataclasses import replace

import numpy as np
import pytest

from hexarm.machines import load
from manipulator.errors import NoSolution, Refused, Unreachable
from manipulator.planning.goal import Flow, Goal, Motion
from manipulator.planning.joint_move import plan_joint_move
from manipulator.planning.plan import MotionState, Plan
from manipulator.planning.planner import compared, plan_goal
from manipulator.planning.start import Start, plan_along_stream, slowed_down
from manipulator.planning.worker import Effort
from manipulator.pose import Pose
from manipulator.setpoint_validator import SetpointValidator
from manipulator.trajectory.executor import Executor

DT = 0.01
TARGETS = {
    'robocake': (0.006, -0.004, 0.004, 0.05, -0.05, 0.1),
    'stewart_6_6': (0.01, -0.02, 0.015, 0.05, -0.1, 0.2),
    'arm_6r': (-0.1, 0.05, 0.1, 0.2, -0.2, 0.5),
    'ur5': (-0.1, 0.05, 0.1, 0.2, -0.2, 0.5),
}


def planned(name):
    machine = load(name)
    k = machine.kinematics
    begin = k.inverse(k.home)
    goal = Goal(k.home.moved(TARGETS[name]), motion=Motion.JOINT)
    plan = plan_goal(machine, Start(MotionState.at_rest(k.home), begin, DT), goal, Effort())
    return machine, begin, goal, plan


@pytest.mark.parametrize('name', TARGETS)
def test_all_joints_go_in_proportion_and_arrive_at_the_goal(name):
    machine, begin, goal, plan = planned(name)
    end = machine.kinematics.inverse(goal.pose, begin)
    joints = plan.joints_at(np.linspace(0.0, plan.duration, 50))
    np.testing.assert_array_equal(joints[0], begin)
    np.testing.assert_allclose(joints[-1], end, atol=1e-12)
    share = (joints - begin) @ (end - begin) / ((end - begin) @ (end - begin))
    np.testing.assert_allclose(joints, begin + share[:, None] * (end - begin), atol=1e-12)
    assert (np.diff(share) >= 0.0).all()
    assert np.abs(plan.at(plan.duration).pose.twist_to(goal.pose)).max() < 1e-7


@pytest.mark.parametrize('name', TARGETS)
def test_the_state_is_that_of_the_joints_by_differences(name):
    _, _, _, plan = planned(name)
    h = 1e-4
    times = np.linspace(0.1, 0.9, 7) * plan.duration
    state, ahead, behind = (plan.at(times + step) for step in (0.0, h, -h))
    twist = behind.pose.twist_to(ahead.pose) / (2 * h)
    np.testing.assert_allclose(state.twist, twist, atol=1e-4 * np.abs(twist).max() + 1e-8)
    change = (ahead.twist - behind.twist) / (2 * h)
    np.testing.assert_allclose(state.acceleration, change, atol=2e-3 * np.abs(change).max())


@pytest.mark.parametrize('name', TARGETS)
def test_joint_moves_keep_the_limits_of_joints_and_platform(name):
    machine, _, _, plan = planned(name)
    times = np.arange(0.0, plan.duration + DT, DT)
    joints, state, limits = plan.joints_at(times), plan.at(times), machine.motion
    speeds = np.abs(np.diff(joints, axis=0)) / DT
    assert (speeds <= 1.01 * limits.joint.speed).all()
    accelerations = np.abs(np.diff(joints, n=2, axis=0)) / DT**2
    assert (accelerations <= 1.01 * limits.joint.acceleration).all()
    assert np.linalg.norm(state.twist[:, :3], axis=1).max() <= 1.01 * limits.linear.speed
    assert np.linalg.norm(state.twist[:, 3:], axis=1).max() <= 1.01 * limits.angular.speed
    assert machine.constraints.admits(state.pose, joints).all()


@pytest.mark.parametrize('part', ['linear', 'angular'])
@pytest.mark.parametrize('name', TARGETS)
def test_a_joint_move_is_as_fast_as_the_platforms_speed_allows(name, part):
    machine = load(name)
    slow = replace(getattr(machine.motion, part), speed=1e-3 if part == 'linear' else 0.01)
    machine = replace(machine, motion=replace(machine.motion, **{part: slow}))
    k = machine.kinematics
    begin, end = k.inverse(k.home), k.inverse(k.home.moved(TARGETS[name]))
    plan = plan_joint_move(machine, k.home, begin, end)
    twist = plan.at(np.linspace(0.0, plan.duration, 200)).twist
    speeds = np.linalg.norm(twist[:, :3] if part == 'linear' else twist[:, 3:], axis=1)
    assert 0.97 * slow.speed <= speeds.max() <= 1.03 * slow.speed


@pytest.mark.parametrize('name', TARGETS)
def test_an_executor_executes_a_joint_move_on_its_joints(name):
    machine, begin, goal, plan = planned(name)
    executor = Executor(machine, machine.kinematics.home, begin, DT)
    executor.pursue(goal)
    joints = []
    while executor.status.result != 'reached':
        pose = executor.step()
        joints.append(executor.joints)
        assert (
            np.abs(machine.kinematics.forward(executor.joints, pose).pose.twist_to(pose)).max()
            < 1e-7
        )
        assert len(joints) < 2000
    np.testing.assert_allclose(joints[-1], plan.joints_at(plan.duration), atol=1e-7)


@pytest.mark.parametrize('name', ['stewart_6_6', 'robocake', 'arm_6r'])
def test_a_plan_is_compared_with_the_other_motion_and_with_the_joints_rated_speed(name):
    machine = load(name)
    k = machine.kinematics
    begin, pose = k.inverse(k.home), k.home.moved(TARGETS[name])
    start = Start(MotionState.at_rest(k.home), begin, DT)
    found = compared(machine, start, Goal(pose, motion=Motion.JOINT), Effort())
    assert found.durations[Motion.JOINT] == found.plan.duration
    line = plan_goal(machine, start, Goal(pose), Effort())
    assert found.durations[Motion.LINE] == line.duration
    longest = np.max(np.abs(k.inverse(pose, begin) - begin) / machine.motion.joint.speed)
    assert found.rated == pytest.approx(longest)
    assert found.rated < found.plan.duration
    assert re.fullmatch(
        r'line [\d.]+ s, joint [\d.]+ s; the joints at their speed limits alone: [\d.]+ s',
        str(found),
    )


def test_a_goal_out_of_reach_is_refused_for_itself():
    machine = load('arm_6r')
    k = machine.kinematics
    start = Start(MotionState.at_rest(k.home), k.inverse(k.home), DT)
    goal = Goal(Pose.from_xyz_rpy((2.0, 0.0, 0.0)), motion=Motion.JOINT)
    with pytest.raises(Unreachable, match='reach is'):
        plan_goal(machine, start, goal, Effort())


def test_a_joint_move_begins_at_rest():
    machine = load('robocake')
    k = machine.kinematics
    moving = MotionState(k.home, np.array([0.01, 0, 0, 0, 0, 0]), np.zeros(6))
    goal = Goal(k.home.moved([0.001, 0, 0, 0, 0, 0]), motion=Motion.JOINT)
    with pytest.raises(Refused, match='begins at rest'):
        plan_goal(machine, Start(moving, k.inverse(k.home), DT), goal, Effort())


def test_a_joint_move_to_a_stop_passes_the_check_of_ik():
    """ik solves the poses for the joints: rounding must not put one beyond its stop."""
    machine = load('arm_6r')
    k = machine.kinematics
    begin = np.radians([0.0, 20.0, 80.0, 90.0, 60.0, 0.0])
    end = begin.copy()
    end[3] = machine.joint_ranges[1][3]
    executor, check = (
        Executor(machine, k.forward(begin).pose, begin, DT),
        SetpointValidator(machine),
    )
    check.note_joints(begin)
    executor.pursue(Goal(k.forward(end).pose, 1.0, motion=Motion.JOINT, joints=end))
    now = 100.0
    while executor.status.result != 'reached':
        now += DT
        np.testing.assert_allclose(check.admit(executor.step(), now), executor.joints, atol=1e-6)
        assert now < 110.0
    np.testing.assert_allclose(executor.joints, end, atol=2e-6)


@pytest.mark.parametrize(
    ('stamps', 'is_stream'), [((1.0, 2.0, 3.0), False), ((1.0, 1.1, 1.2), True)]
)
def test_joint_goals_are_a_stream_only_if_they_come_in_a_row(stamps, is_stream):
    machine, begin, _, plan = planned('arm_6r')
    change = plan.joints_at(plan.duration) - begin
    executor = Executor(machine, machine.kinematics.home, begin, DT)
    for share, stamp in zip((0.1, 0.2, 0.3), stamps, strict=True):
        joints = begin + share * change
        pose = machine.kinematics.forward(joints).pose
        executor.pursue(Goal(pose, stamp, motion=Motion.JOINT, joints=joints))
        for _ in range(10):
            executor.step()
    assert executor.is_busy
    assert executor.is_streaming is is_stream


class NoPose(Plan):
    """A plan whose joints fix no pose on the way."""

    duration = 0.1

    def at(self, times):
        raise NoSolution('forward kinematics found no pose')

    def where(self, time):
        return 'on the way'


def test_a_plan_whose_joints_fix_no_pose_is_refused_and_a_stream_goes_on_without_it():
    machine, begin, _, _ = planned('robocake')
    start = Start(MotionState.at_rest(machine.kinematics.home), begin, DT)
    with pytest.raises(Refused, match='on the joint move: forward kinematics found no pose'):
        slowed_down(machine, start, lambda slowdown: NoPose(), Effort())
    flow = Flow(np.full(6, 0.01), np.zeros(6), due=0.1, until=0.1)
    assert plan_along_stream(machine, start, flow, Effort(), lambda attempt: NoPose()) is None
