"""A motion controller with a machine that does as it is told, in a time of its own."""

import pytest

from hexarm.machines import load
from manipulator.trajectory.controller import MotionController
from world.controller import Thread
from world.timeline import Timeline

DT = 0.01


class Stage:
    """The controller (`core`), its bridge and its machine; `setpoints` and `statuses` came out."""

    def __init__(self, machine, planning_s=None):
        self.timeline = Timeline()
        self.worker = None if planning_s is None else Thread(self.timeline, planning_s)
        self.core = MotionController(machine, DT, worker=self.worker)
        self.machine = machine
        self.pose = machine.kinematics.home
        self.state, self.is_followed = 'enabled', True
        self.does_bridge_say = self.does_pose_come = True
        self.setpoints, self.statuses, self.refusals = [], [], []

    @property
    def now(self):
        return self.timeline.now

    @property
    def status(self):
        return self.statuses[-1]

    @property
    def executor(self):
        return self.core.supervisor.executor

    def run(self, ticks):
        for _ in range(ticks):
            self.tick()

    def tick(self, period=DT, within=0.001):
        """One tick, `period` after the last one, that takes so long (s); the setpoint."""
        self.timeline.run(period)
        self.report()
        self.core.begin_tick(self.now)
        pose = self.core.end_tick(self.now + within)
        if pose is not None:
            self.pose = pose
            self.setpoints.append(pose)
        self.statuses += self.core.news.take()
        return pose

    def report(self):
        """What bridge and machine say before a tick."""
        if self.does_bridge_say:
            self.core.note_machine_state(self.state, self.is_followed, False, self.now)
        if self.does_pose_come:
            self.core.note_joints(self.machine.kinematics.inverse(self.pose))
            self.core.note_pose(self.pose, self.now)

    def pursue(self, goal, **options):
        self.core.pursue(goal, self.refuse, self.now, **options)

    def follow(self, path):
        self.core.follow(path, self.refuse, self.now)

    def refuse(self, error):
        self.refusals.append(str(error))


@pytest.fixture
def staged():
    """Makes a stage on which the machine of that name holds at home."""

    def make(name='robocake', planning_s=None):
        stage = Stage(load(name), planning_s)
        stage.run(3)
        assert stage.setpoints
        return stage

    return make


@pytest.fixture
def stage(staged):
    """The hexapod's."""
    return staged()


@pytest.fixture
def slow(staged):
    """A hexapod's whose plans take more than three ticks."""
    return staged(planning_s=3.5 * DT)
