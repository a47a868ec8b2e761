"""From wherever a stick has led, the machine goes home again, and ik takes the same branch."""

import numpy as np
import pytest

from hexarm.machines import load
from manipulator.planning.goal import Goal
from manipulator.setpoint_validator import SetpointValidator
from manipulator.teleop.jog_modes import Feedback
from manipulator.teleop.modes import jog_mode
from manipulator.trajectory.executor import Executor
from manipulator.trajectory.jogging import JogCommand
from sampling import some

TICK = 0.01
FREE = jog_mode('free', Feedback.for_delay(0.0))
AXES = [sign * np.eye(6)[axis] for axis in range(6) for sign in (1, -1)]
RANDOM = list(np.random.default_rng(3).normal(size=(12, 6)))
EDGES = [('robocake', direction) for direction in AXES + RANDOM]
EDGES += [('stewart_6_3', direction) for direction in some(AXES + RANDOM, 4)]  # has one branch
FULL = np.array([0.03, 0.03, 0.03, 0.5, 0.5, 0.5])


class Driven:
    """A executor whose setpoints ik checks, tick by tick."""

    def __init__(self, machine):
        home = machine.kinematics.home
        joints = machine.kinematics.inverse(home)
        self.executor, self.check = (
            Executor(machine, home, joints, TICK),
            SetpointValidator(machine),
        )
        self.check.note_joints(joints)
        self.now = 100.0

    def run(self, seconds):
        for _ in range(round(seconds / TICK)):
            pose = self._tick()
        return pose

    def run_until_it_stands(self, seconds):
        before = self.executor.state.pose
        for _ in range(round(seconds / TICK)):
            pose = self._tick()
            if not before.twist_to(pose).any():
                break
            before = pose
        return pose

    def run_until_reached(self, seconds):
        for _ in range(round(seconds / TICK)):
            pose = self._tick()
            if self.executor.status.result == 'reached':
                return pose
        raise AssertionError(self.executor.status)

    def _tick(self):
        self.now += TICK
        pose = self.executor.step()
        joints = self.check.admit(pose, self.now)
        assert np.abs(joints - self.executor.joints).max() < 1e-6
        self.check.note_joints(joints)
        return pose


@pytest.mark.parametrize(('name', 'direction'), EDGES)
def test_home_is_reached_from_the_edge_where_branches_meet(name, direction):
    machine = load(name)
    driven = Driven(machine)
    driven.executor.jog(
        JogCommand('cmd_vel/joy', FULL * direction / np.abs(direction).max(), '', FREE)
    )
    driven.run(0.1)
    driven.run_until_it_stands(4.0)
    driven.executor.jog(None)
    edge = driven.run(0.3)
    assert np.abs(edge.twist_to(machine.kinematics.home)).max() > 0.005
    driven.executor.pursue(Goal(machine.kinematics.home, 1.0))
    there = driven.run_until_reached(5.0)
    assert np.abs(there.twist_to(machine.kinematics.home)).max() < 1e-9


def test_home_is_reached_from_where_a_crank_is_nearer_to_the_other_branch():
    """Crank 5 stands at 0.8 rad: from there home's −0.38 is nearer than home's 2.09."""
    machine = load('robocake')
    driven = Driven(machine)
    goal = machine.kinematics.home.moved([0.0155, 0, 0, 0, 0, 0])
    assert machine.kinematics.inverse(goal).min() < 0.85
    driven.executor.pursue(Goal(goal, 1.0))
    driven.run(2.0)
    driven.executor.pursue(Goal(machine.kinematics.home, 2.0))
    driven.run_until_reached(2.0)
