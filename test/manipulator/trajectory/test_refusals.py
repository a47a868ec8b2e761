"""What a executor says of goals, cycles and paths that the machine cannot drive, or only just."""

import re
from dataclasses import replace

import numpy as np
import pytest

from hexarm.machines import load
from manipulator import rotation as so3
from manipulator.motion_limits import BRAKING_SHARE, Derivatives, JointDerivatives, MotionLimits
from manipulator.planning.check import first_fault
from manipulator.planning.cycle import Cycle
from manipulator.pose import Pose
from manipulator.trajectory.executor import Executor, Goal

MACHINE = load('robocake')
HOME = MACHINE.kinematics.home
DT = 0.01


def raised(height):
    return HOME.moved([0.0, 0.0, height, 0.0, 0.0, 0.0])


def executor(machine=MACHINE, pose=HOME):
    return Executor(machine, pose, machine.kinematics.inverse(pose), DT)


def drive(motion, goal):
    """To its end: the poses of the ticks until then."""
    motion.pursue(goal)
    poses = []
    while not poses or motion.status.result in ('idle', 'planning', 'moving'):
        poses.append(motion.step())
        assert len(poses) < 1000
    return poses


def test_a_goal_beyond_a_limit_is_refused_for_itself_and_not_for_a_moment_of_the_path():
    motion = executor()
    drive(motion, Goal(raised(-0.02), 5.0))
    assert (motion.status.result, motion.status.goal_stamp) == ('refused', 5.0)
    assert motion.status.reason.startswith('platform height 0.02119 m below 0.02339')


def test_a_line_that_leaves_the_reach_is_refused_with_the_place_and_the_reason():
    start = Pose([-0.0133, -0.0048, 0.026], so3.exp([0.083, 0.085, 0.113]))
    goal = Pose([-0.0056, 0.0144, 0.0281], so3.exp([0.049, -0.046, 0.03]))
    motion = executor(pose=start)
    drive(motion, Goal(goal, 6.0))
    assert (motion.status.result, motion.status.goal_stamp) == ('refused', 6.0)
    pattern = r'at 2\d % of the line: leg 2: crank angle 3\.6\d+ rad outside .*'
    assert re.fullmatch(pattern, motion.status.reason)


def test_a_path_on_which_an_arm_would_have_to_turn_round_is_refused_before_it_takes_for_ever():
    """Behind joint 1's axis, which does not turn that far: its step is the same however slow."""
    arm = load('arm_6r')
    turn = np.array([2.0, 0.0, 0.0, 0.0, 0.0, 0.0])
    rest = arm.kinematics.rest
    right, left = (arm.kinematics.forward(rest + side * turn).pose for side in (-1.0, 1.0))
    motion = Executor(arm, right, rest - turn, DT)
    drive(motion, Goal(left, 7.0))
    assert (motion.status.result, motion.status.goal_stamp) == ('refused', 7.0)
    pattern = r'at 46 % of the line: joint 1: joint angle -2\.9672 rad outside .*; a joint move .*'
    assert re.fullmatch(pattern, motion.status.reason)


def test_a_machine_that_stands_beyond_a_limit_is_driven_in_and_not_further_out():
    motion = executor(pose=raised(-0.0182))
    drive(motion, Goal(raised(-0.0190), 1.0))
    assert motion.status.result == 'refused'
    assert 'platform height' in motion.status.reason
    poses = drive(motion, Goal(raised(0.0), 2.0))
    assert (motion.status.result, motion.status.goal_stamp) == ('reached', 2.0)
    assert (np.diff([pose.position[2] for pose in poses]) >= 0.0).all()


@pytest.mark.parametrize('way', [1e-9, 1e-8, 1e-7])
def test_a_goal_that_takes_no_more_than_a_tick_is_driven_to_in_one(way):
    motion = executor()
    poses = [HOME, *drive(motion, Goal(HOME.moved([way, 0, 0, 0, 0, 0]), 3.0))]
    assert motion.status.result == 'reached'
    steps = np.diff([pose.position[0] for pose in poses])
    assert np.count_nonzero(steps) == 1
    assert steps.sum() == pytest.approx(way, rel=1e-6)


def refusal(motion, cycle):
    """Why a cycle is not begun; '' where it is."""
    motion.start_cycle(cycle, 4.0)
    motion.step()
    assert motion.status.goal_stamp == 4.0
    return motion.status.reason if motion.status.result == 'refused' else ''


def limited(**parts):
    """The machine with these limits of motion, and none that matters but for them."""
    free = Derivatives(1e3, 1e6, 1e9)
    joint = JointDerivatives.of(1e3, 1e6)
    motion = MotionLimits(parts.get('linear', free), parts.get('angular', free), joint)
    return replace(MACHINE, motion=motion)


@pytest.mark.parametrize('limit', [0.02, 0.5, 3.0])
@pytest.mark.parametrize('part', ['linear', 'angular'])
def test_a_cycle_reports_how_many_times_it_is_faster_than_platform_or_tool_may_be(part, limit):
    axis = 0 if part == 'linear' else 5
    amplitude, frequency = np.zeros(6), np.full(6, 10.0)
    amplitude[axis] = 0.005 if part == 'linear' else 0.1
    peak = 2 * np.pi * frequency[0] * amplitude[axis]
    motion = executor(limited(**{part: Derivatives(limit, 1e6, 1e9)}))
    reason = refusal(motion, Cycle(HOME, amplitude, frequency, np.zeros(6)))
    if peak < limit:
        assert reason == ''
    else:
        name = 'linear speed' if part == 'linear' else 'turning speed'
        assert f'{name} is {peak / limit:.2f} times too fast' in reason


@pytest.mark.parametrize(('axis', 'part'), [(2, 'linear'), (3, 'angular')])
def test_a_cycle_reports_how_many_times_it_must_be_slower_for_the_acceleration_of_its_own_part(
    axis, part
):
    amplitude, rate = np.zeros(6), 2 * np.pi * 2.0
    amplitude[axis] = 0.005 if part == 'linear' else 0.1
    peak = rate**2 * amplitude[axis]
    cycle = Cycle(HOME, amplitude, np.full(6, 2.0), np.zeros(6))
    other = 'angular' if part == 'linear' else 'linear'
    assert refusal(executor(limited(**{other: Derivatives(1e-3, 1e-3, 1e9)})), cycle) == ''
    strict = Derivatives(1e3, peak / 9.0 / (1.0 - BRAKING_SHARE))
    name = 'linear acceleration' if part == 'linear' else 'turning acceleration'
    reason = refusal(executor(limited(**{part: strict})), cycle)
    assert re.search(rf'{name} is [23]\.\d\d times too fast', reason)


def test_nothing_came_of_a_path_is_reported_with_its_stamp_and_reason():
    motion = executor()
    motion.expect(8.0)
    assert (motion.status.result, motion.status.goal_stamp) == ('planning', 8.0)
    assert motion.expected == 8.0
    motion.refuse(8.0, 'the path has a corner')
    text = motion.status
    assert (text.result, text.goal_stamp, text.reason) == ('refused', 8.0, 'the path has a corner')
    assert motion.expected is None


@pytest.mark.parametrize('metres', [1e7, -1e14, 1e160, -1e308])
@pytest.mark.parametrize('ticks', [0, 10])
@pytest.mark.parametrize('name', ['robocake', 'arm_6r'])
def test_a_goal_farther_away_than_any_machine_is_refused_at_rest_and_in_motion(
    name, ticks, metres
):
    machine = load(name)
    home = machine.kinematics.home
    motion = executor(machine, home)
    motion.pursue(Goal(home.moved([0.0, 0.0, 0.004, 0.0, 0.0, 0.0]), 1.0))
    for _ in range(ticks):
        motion.step()
    drive(motion, Goal(Pose(home.position + metres * np.eye(3)[2], home.rotation), 2.0))
    assert (motion.status.result, motion.status.goal_stamp) == ('refused', 2.0)
    assert 'm from home, needs at most' in motion.status.reason


@pytest.mark.parametrize('tick', [0, 1, 2, 5])
def test_the_first_pose_out_of_reach_is_named_wherever_it_is(tick):
    heights = np.where(np.arange(8) < tick, 0.0, 0.2)
    poses = Pose(HOME.position + heights[:, None] * [0, 0, 1], np.tile(HOME.rotation, (8, 1, 1)))
    joints = MACHINE.kinematics.inverse_along(poses, MACHINE.kinematics.inverse(HOME))
    at, reason = first_fault(MACHINE, MACHINE.constraints, poses, joints)
    assert at == tick
    assert re.match(r'leg \d: rod too short by', reason)
