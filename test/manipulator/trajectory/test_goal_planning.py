"""Goals that take a while to plan: the machine goes on, and answers to what comes meanwhile."""

from concurrent.futures import Future
from dataclasses import replace
from threading import Event

import numpy as np
import pytest

from hexarm.machines import load
from manipulator.errors import ManipulatorError, Refused
from manipulator.planning.cycle import Cycle
from manipulator.planning.goal import Goal, Motion
from manipulator.planning.joint_move import plan_joint_move
from manipulator.planning.worker import Effort, Job
from manipulator.pose import Pose
from manipulator.teleop.jog_modes import Feedback
from manipulator.teleop.modes import jog_mode
from manipulator.trajectory.active_plan import ActivePlan
from manipulator.trajectory.executor import Executor
from manipulator.trajectory.goal_planning import LEADS, Planning
from manipulator.trajectory.jogging import JogCommand

DT = 0.01


class Later:
    """Works a task out when its ticks are over; `tick` lets one pass."""

    is_beside = True

    def __init__(self, ticks):
        self.ticks = ticks
        self.waiting = []
        self.cancelled = 0

    def submit(self, task):
        future, cancelled = Future(), Event()
        self.waiting.append([self.ticks, task, future, cancelled])
        return Job(future, cancelled.set)

    def tick(self):
        for entry in self.waiting:
            entry[0] -= 1
        done = [entry for entry in self.waiting if entry[0] < 0]
        self.waiting = [entry for entry in self.waiting if entry[0] >= 0]
        for _, task, future, cancelled in done:
            if cancelled.is_set():
                self.cancelled += 1
                continue
            try:
                future.set_result(task(Effort()))
            except ManipulatorError as error:
                future.set_exception(error)


class Costly:
    """The kinematics of a machine, as if it had no closed form."""

    is_explicit = False

    def __init__(self, inner):
        self._inner = inner

    def __getattr__(self, name):
        return getattr(self._inner, name)


EXPLICIT = load('robocake')
MACHINE = replace(EXPLICIT, kinematics=Costly(EXPLICIT.kinematics))
HOME = MACHINE.kinematics.home
FREE = jog_mode('free', Feedback.for_delay(0.0))


class Slow:
    """A executor whose plans take so many ticks; what it commanded, and what it reported."""

    def __init__(self, ticks, machine=MACHINE):
        self.worker = Later(ticks)
        joints = machine.kinematics.inverse(HOME)
        self.executor = Executor(machine, HOME, joints, DT, self.worker)
        self.poses, self.joints, self.reports = [HOME], [joints], []

    def run(self, ticks):
        for _ in range(ticks):
            self.worker.tick()
            self.poses.append(self.executor.step())
            self.joints.append(self.executor.joints)
            status = self.executor.status
            report = status.result, status.goal_stamp
            if not self.reports or self.reports[-1] != report:
                self.reports.append(report)

    @property
    def steps(self):
        """How far the platform went at each tick, m."""
        positions = np.array([pose.position for pose in self.poses])
        return np.linalg.norm(np.diff(positions, axis=0), axis=1)

    def check_limits(self):
        limits = MACHINE.motion.joint
        joints = np.array(self.joints)
        assert np.abs(np.diff(joints, axis=0)).max() <= 1.01 * limits.speed * DT
        assert np.abs(np.diff(joints, n=2, axis=0)).max() <= 1.01 * limits.acceleration * DT**2


def pose(x=0.0, y=0.0, z=0.0412):
    return Pose.from_xyz_rpy((x, y, z))


def test_a_goal_is_held_up_by_its_planning_and_reported_meanwhile():
    slow = Slow(30)
    slow.executor.pursue(Goal(pose(x=0.006), 1.0))
    slow.run(30)
    assert slow.steps.max() == 0.0
    slow.run(120)
    results = [result for result, _ in slow.reports]
    assert results == ['idle', 'planning', 'moving', 'reached']
    assert slow.poses[-1].position[0] == pytest.approx(0.006)
    slow.check_limits()


def test_quick_planning_is_not_reported():
    quick = Slow(3)
    quick.executor.pursue(Goal(pose(x=0.006), 1.0))
    quick.run(120)
    assert [result for result, _ in quick.reports] == ['idle', 'moving', 'reached']


def test_a_stop_while_a_goal_is_planned_drops_it():
    slow = Slow(30)
    slow.executor.pursue(Goal(pose(x=0.006), 1.0))
    slow.run(20)
    slow.executor.stop()
    slow.run(60)
    assert slow.steps.max() == 0.0
    assert slow.reports[-1] == ('stopped', 1.0)
    assert slow.worker.cancelled == 1


def test_a_stop_in_motion_is_obeyed_while_the_next_goal_is_planned():
    slow = Slow(2)
    slow.executor.pursue(Goal(pose(x=0.012), 1.0))
    slow.run(15)
    slow.worker.ticks = 60
    slow.executor.pursue(Goal(pose(y=0.012), 2.0))
    slow.run(5)
    slow.executor.stop()
    slow.run(100)
    assert slow.steps[-70:].max() == 0.0
    assert slow.poses[-1].position[1] == pytest.approx(0.0, abs=1e-9)
    slow.check_limits()


def test_a_jog_that_begins_while_a_goal_is_planned_drops_it():
    slow = Slow(30)
    slow.executor.pursue(Goal(pose(x=0.01), 1.0))
    slow.run(10)
    slow.executor.jog(JogCommand('cmd_vel/joy', np.array([0, 0.01, 0, 0, 0, 0.0]), '', FREE))
    slow.run(60)
    slow.executor.jog(None)
    slow.run(60)
    assert slow.poses[-1].position[1] > 0.001
    assert slow.poses[-1].position[0] == pytest.approx(0.0, abs=1e-9)
    slow.check_limits()


def test_of_goals_that_come_while_one_is_planned_the_newest_is_driven_last():
    slow = Slow(10)
    for k in range(5):
        slow.executor.pursue(Goal(pose(x=0.002 * k, y=0.003), 1.0 + k))
        slow.run(1)
    slow.run(200)
    assert slow.reports[-1] == ('reached', 5.0)
    assert slow.poses[-1].position[0] == pytest.approx(0.008)
    slow.check_limits()


@pytest.mark.parametrize('ticks', [0, 2, 8, 30])
def test_a_goal_in_motion_is_joined_without_a_stop(ticks):
    slow = Slow(2)
    slow.executor.pursue(Goal(pose(x=0.012), 1.0))
    slow.run(12)
    slow.worker.ticks = ticks
    slow.executor.pursue(Goal(pose(x=0.012, y=0.006), 2.0))
    slow.run(200)
    assert slow.reports[-1] == ('reached', 2.0)
    assert slow.poses[-1].position[1] == pytest.approx(0.006)
    moving = slow.steps[16 : np.flatnonzero(slow.steps > 1e-9)[-1] - 20]
    if ticks < LEADS[1]:
        assert moving.min() > 1e-5
    slow.check_limits()


def test_a_goal_whose_plans_always_come_too_late_is_driven_from_rest():
    slow = Slow(2)
    slow.executor.pursue(Goal(pose(x=0.02), 1.0))
    slow.run(12)
    slow.worker.ticks = LEADS[-1] + 20
    slow.executor.override(0.2)  # so that it is still in motion after all attempts
    slow.executor.pursue(Goal(pose(y=0.01), 2.0))
    slow.run(2000)
    assert slow.reports[-1] == ('reached', 2.0)
    slow.check_limits()


def behind_a_circle(slow, seconds=6.0):
    """How far the commanded pose is behind goals at 60 Hz on a circle of 12 mm/s, tick by tick."""
    behind, due = [], 0.0
    for t in np.arange(0.0, seconds, DT):
        wanted = pose(x=0.006 * np.sin(2 * t), y=0.006 * np.cos(2 * t))
        if t >= due:
            slow.executor.pursue(Goal(wanted, 1.0 + t))
            due += 1 / 60
        slow.run(1)
        behind.append(np.linalg.norm(slow.poses[-1].position - wanted.position))
    return np.array(behind)


@pytest.mark.parametrize(('ticks', 'lag'), [(0, 0.1), (1, 0.1), (12, 0.65)])
def test_a_stream_of_goals_is_followed_while_each_takes_its_time(ticks, lag):
    slow = Slow(ticks)
    assert behind_a_circle(slow)[200:].max() < 0.012 * lag
    if ticks < 2:
        assert slow.steps[200:].min() > 0.0  # it does not stop and go
    slow.check_limits()


def test_a_stream_of_goals_is_followed_closest_by_an_explicit_inverse():
    """Its short moves are planned within the tick, however long the worker takes."""
    slow = Slow(100, EXPLICIT)
    assert behind_a_circle(slow)[200:].max() < 0.012 * 0.04
    slow.check_limits()


def test_a_long_move_leaves_the_tick_also_with_an_explicit_inverse():
    slow = Slow(30, EXPLICIT)
    slow.executor.override(0.5)
    slow.executor.pursue(Goal(pose(x=0.006), 1.0, motion=Motion.JOINT))
    slow.run(30)
    assert slow.steps.max() == 0.0
    slow.run(300)
    assert slow.reports[-1] == ('reached', 1.0)


def test_a_goal_out_of_reach_is_refused_and_the_one_before_goes_on():
    slow = Slow(8)
    slow.executor.pursue(Goal(pose(x=0.01), 1.0))
    slow.run(15)
    slow.executor.pursue(Goal(pose(x=0.06), 2.0))
    slow.run(150)
    assert ('refused', 2.0) in slow.reports
    assert slow.reports[-1] == ('reached', 1.0)
    assert slow.poses[-1].position[0] == pytest.approx(0.01)


def test_a_cycle_is_checked_and_approached_beside_the_loop():
    slow = Slow(20)
    amplitude = [0.003, 0, 0, 0, 0, 0]
    slow.executor.start_cycle(Cycle(HOME, amplitude, [0.5] * 6, [0.5] * 6), 3.0)
    slow.run(300)
    assert slow.executor.status.mode == 'cycle'
    assert slow.reports[-1] == ('moving', 3.0)
    slow.check_limits()


def test_a_machine_that_is_released_waits_for_no_plan():
    slow = Slow(30)
    slow.executor.pursue(Goal(pose(x=0.006), 1.0))
    slow.run(10)
    slow.executor.close()
    slow.run(60)
    assert slow.worker.cancelled == 1
    assert slow.steps.max() == 0.0


@pytest.mark.parametrize('accepted', [0, 1])
def test_a_goal_that_the_worker_does_not_take_is_refused_and_the_machine_goes_on(accepted):
    slow = Slow(2)
    slow.executor.pursue(Goal(pose(x=0.012), 1.0))
    slow.run(12)
    submit, submitted = slow.worker.submit, []

    def full(task):
        submitted.append(task)
        if len(submitted) > accepted:
            raise Refused('8 plans wait already')
        return submit(task)

    slow.worker.submit, slow.worker.ticks = full, LEADS[0] + 2  # the first plan comes too late
    slow.executor.pursue(Goal(pose(y=0.006), 2.0))
    slow.run(150)
    assert len(submitted) == accepted + 1
    assert ('refused', 2.0) in slow.reports
    assert slow.reports[-1] == ('reached', 1.0)


def test_a_goal_during_a_joint_move_is_planned_from_the_joints_that_the_move_has():
    """Beside singular postures, which it passes, the poses alone do not tell them."""
    arm = load('arm_6r')
    begin = np.array([0.2, 0.6, -0.9, -1.0, 0.5, 2.0])
    end = np.array([-0.2, 0.5, 0.6, 1.0, -0.5, 1.0])
    move = plan_joint_move(arm, arm.kinematics.forward(begin).pose, begin, end)
    active, worker = ActivePlan(move), Later(1)
    for time in np.arange(DT, move.duration - LEADS[0] * DT, DT):
        active = active.at_time(time)
        planning = Planning(replace(arm, kinematics=Costly(arm.kinematics)), DT, worker)
        planning.request(Goal(arm.kinematics.home, 1.0), move.at(time).pose, move.joints_at(time))
        planning.step(active, move.joints_at(time))
        _, task, *_ = worker.waiting[-1]
        _, ahead = task.args
        assert ahead.joints_at_end(arm) == pytest.approx(
            move.joints_at(time + LEADS[0] * DT), abs=1e-6
        )


def test_what_three_plans_were_too_late_for_may_still_be_planned_from_rest():
    arm = load('arm_6r')
    begin = arm.kinematics.inverse(arm.kinematics.home)
    move = plan_joint_move(arm, arm.kinematics.home, begin, begin + 1.5 * np.eye(6)[0])
    active, worker = ActivePlan(move), Later(LEADS[-1] + 1)
    planning = Planning(replace(arm, kinematics=Costly(arm.kinematics)), DT, worker)
    planning.request(Goal(arm.kinematics.home, 1.0), arm.kinematics.home, begin)
    failures = []
    for time in np.arange(DT, move.duration - DT, DT):
        active = active.at_time(time)
        worker.tick()
        failures.append(planning.step(active, move.joints_at(time)))
    (failed,) = filter(None, failures)
    assert 'too late' in str(failed.error)
    assert not failed.is_final
