"""What a stick asks for is done in its frame, takes over from plans, or is explained."""

import numpy as np
import pytest

from hexarm.machines import load
from manipulator.errors import Refused
from manipulator.planning.cycle import Cycle
from manipulator.planning.goal import Goal
from manipulator.teleop.jog_modes import Feedback
from manipulator.teleop.modes import jog_mode
from manipulator.trajectory.jogging import JogCommand, Jogging

DT = 0.01
TICKS = 200
ROBOCAKE = load('robocake')
HOME = ROBOCAKE.kinematics.home


@pytest.fixture
def robocake(at_home):
    return at_home(ROBOCAKE)


def test_twist_is_the_pivots_in_the_axes_of_its_frame(machine, at_home):
    motion, frames = at_home(machine), machine.frames
    size = 0.3 * machine.motion.linear.speed
    start = frames.platform(motion.state.pose)
    motion.run(60, [size, 0, 0, 0, 0, 0])
    motion.run(30)
    shift = start.twist_to(frames.platform(motion.state.pose))
    assert shift[0] > 0.3 * size
    assert np.abs(shift[1:]).max() < 0.02 * shift[0]
    before = motion.state.pose
    motion.run(60, [0, 0, 0, 0, 0, 0.3 * machine.motion.angular.speed], frame='tool')
    motion.run(30)
    shift = before.twist_to(motion.state.pose)
    assert np.linalg.norm(shift[3:]) > 0.01
    assert np.linalg.norm(shift[:3]) < 2e-3 * np.linalg.norm(shift[3:])


def test_jog_reports_why_it_is_scaled_but_not_at_every_tick(machine, at_home):
    motion = at_home(machine)
    reasons = set()
    for _ in range(TICKS):
        motion.run(1, [0, 0, 1.5 * machine.motion.linear.speed, 0, 0, 0])
        reasons.add(motion.status.reason)
    assert motion.status.mode == 'jog'
    assert any('scaled to' in reason for reason in reasons)
    assert len(reasons) <= TICKS * DT / 0.5 + 1


def test_jog_brakes_the_plan_along_its_path_and_drops_it(robocake):
    robocake.pursue(Goal(HOME.moved([0.012, 0.006, 0, 0, 0, 0]), 7.0))
    robocake.run(15)
    seen = []
    for _ in range(60):
        robocake.run(1, [0, 0, 0.02, 0, 0, 0])
        seen.append(robocake.status)
    assert ('stopped', 7.0, 'cmd_vel/joy took over the machine') in [
        (s.result, s.goal_stamp, s.reason) for s in seen
    ]
    robocake.check_limits()
    for pose in robocake.poses:
        shift = pose.position - HOME.position
        assert shift[1] == pytest.approx(shift[0] / 2, abs=1e-9)
    rest = robocake.run(100)
    assert np.abs(rest[-1].twist_to(rest[-30])).max() == 0.0
    assert (robocake.status.mode, robocake.status.result) == ('hold', 'idle')


@pytest.mark.parametrize('ticks_of_the_goal', [0, 1, 15])
def test_a_single_jog_command_drops_a_goal_that_is_driven_or_waits(robocake, ticks_of_the_goal):
    goal = HOME.moved([0.012, 0.006, 0, 0, 0, 0])
    robocake.pursue(Goal(goal, 7.0))
    robocake.run(ticks_of_the_goal)
    robocake.run(1, [0, 0, 0.001, 0, 0, 0])
    robocake.run(200)
    assert robocake.status.mode == 'hold'
    assert robocake.status.result != 'reached'
    assert np.abs(robocake.state.pose.twist_to(goal)).max() > 1e-3
    robocake.check_limits()


def test_a_jog_command_drops_a_cycle_on_the_path_to_its_first_pose(robocake):
    robocake.start_cycle(Cycle(HOME, [0.003] * 3 + [0.0] * 3, [0.5] * 6, [1.0] * 6))
    robocake.run(5)
    robocake.run(1, [0, 0, 0.001, 0, 0, 0])
    poses = robocake.run(200)
    assert robocake.status.mode == 'hold'
    assert np.abs(poses[-1].twist_to(poses[-100])).max() == 0.0


def test_no_path_is_expected_during_a_jog_and_one_that_was_is_dropped(robocake):
    robocake.expect(3.0)
    robocake.run(5, [0, 0, 0.01, 0, 0, 0])
    assert robocake.expected is None
    with pytest.raises(Refused, match='cmd_vel/joy controls the machine'):
        robocake.expect(4.0)
    assert robocake.expected is None
    assert robocake.status.mode == 'jog'


def test_goals_and_cycles_are_refused_during_a_jog_and_taken_after_it(robocake):
    robocake.run(5, [0, 0, 0.01, 0, 0, 0])
    goal = Goal(HOME, 3.0)
    with pytest.raises(Refused, match='cmd_vel/joy controls the machine'):
        robocake.pursue(goal)
    with pytest.raises(Refused, match='cmd_vel/joy controls the machine'):
        robocake.start_cycle(Cycle(HOME, [0.001] * 6, [0.5] * 6, [0] * 6))
    robocake.jog(None)
    robocake.pursue(goal)
    robocake.run(100)
    assert (robocake.status.result, robocake.status.goal_stamp) == ('reached', 3.0)


def test_paused_jog_stands_still_and_reports_that(robocake):
    robocake.pause(True)
    poses = robocake.run(20, [0, 0, 0.01, 0, 0, 0])
    assert np.abs(poses[0].twist_to(poses[-1])).max() == 0.0
    assert 'paused' in robocake.status.reason


def test_mode_that_makes_no_sense_stands_still_and_reports_why(at_home):
    machine = load('arm_6r')
    motion = at_home(machine)
    here = jog_mode('look_at', Feedback.for_delay(0.0), machine.kinematics.home.position)
    poses = motion.run(20, [0.1, 0, 0, 0, 0, 0], here)
    assert np.abs(poses[0].twist_to(poses[-1])).max() < 1e-12
    assert 'look-at point' in motion.status.reason


class Latching:
    """A jog mode that passes twists through, or refuses, and counts how often it was latched."""

    def __init__(self):
        self.latches, self.refuses = 0, False

    def latched(self, pose):
        self.latches += 1
        return self

    def step(self, command, pose, midway):
        if self.refuses:
            raise Refused('not here')
        return command, self


def test_a_mode_holds_on_to_what_it_has_latched_until_it_refuses_or_another_one_comes():
    jogging = Jogging(ROBOCAKE, HOME, ROBOCAKE.kinematics.inverse(HOME), DT)
    one, other = Latching(), Latching()

    def jog(mode, ticks=5):
        for _ in range(ticks):
            jogging.step(JogCommand('joy', np.full(6, 1e-3), '', mode), 1.0, None)

    jog(one)
    jog(other)
    assert (one.latches, other.latches) == (1, 1)
    other.refuses = True
    jog(other, 1)
    other.refuses = False
    jog(other)
    assert (one.latches, other.latches) == (1, 2)
