"""What else a user may ask of a machine: what the services and topics of its nodes do."""

import numpy as np

from manipulator.errors import ManipulatorError, Refused
from manipulator.planning.cycle import Cycle
from manipulator.planning.goal import Goal
from manipulator.planning.path import Tolerance
from manipulator.planning.path_timing import PathRequest, plan_path
from manipulator.pose import Pose
from world.controller import DT

SWING = np.array([0.003, 0.003, 0.0015, 0.05, 0.05, 0.04])
"""Amplitudes of the cycle, m and rad: those of the node's parameters."""

TOLERANCE = Tolerance(1e-4, np.radians(0.1))


class Requests:
    """Of the motion controller; Refused says why something is not done."""

    def __init__(self, world):
        self._world = world

    @property
    def _supervisor(self):
        return self._world.controller.supervisor

    def stop(self):
        """trajectory/stop: brakes along the way."""
        self._supervisor.executor.stop()
        self._world.controller.teleop.stop()

    def pause(self, is_paused):
        self._supervisor.pause(is_paused)

    def override(self, rate):
        self._supervisor.override(rate)

    def pivot(self, point):
        self._supervisor.set_pivot(point)

    def tool(self, name):
        self._supervisor.use_tool(name)

    def mode(self, name, point=None):
        if point is not None:
            self._world.controller.teleop.look_at(np.array(point))
        self._world.controller.teleop.set_mode(name)

    def cycle(self, amplitude=SWING, frequency=0.5, phase=0.0):
        executor = self._supervisor.executor
        form = (np.resize(amplitude, 6), np.full(6, frequency), np.resize(phase, 6))
        executor.start_cycle(Cycle(executor.state.pose, *form), self._world.user.stamp)

    def home(self):
        """Goes there, at full speed; waits until it is there."""
        self.override(1.0)
        return self._world.go_to(self._world.machine.kinematics.home)

    def path(self, poses, speed=None, seconds=0.1):
        """goal_path: poses (n,), worked out in so many seconds; its stamp."""
        stamp, executor = self._world.user.stamp, self._supervisor.executor
        fastest = self._supervisor.machine.motion.linear.speed
        request = PathRequest(poses, speed or fastest, TOLERANCE)
        machine, near = self._supervisor.machine, executor.joints
        executor.expect(stamp)

        def take():
            if self._is_expected(stamp):
                self._take_path(machine, request, near, stamp)

        self._world.timeline.after(seconds, lambda: self._world.controller.handle(take))
        return stamp

    def _is_expected(self, stamp):
        try:
            return self._supervisor.executor.expected == stamp
        except Refused:
            return False

    def _take_path(self, machine, request, near, stamp):
        executor = self._supervisor.executor
        try:
            outcome = plan_path(machine, request, near, DT)
        except ManipulatorError as error:
            executor.refuse(stamp, str(error))
            return
        if isinstance(outcome, Pose):
            executor.pursue(Goal(outcome, stamp))
        else:
            executor.pursue(Goal(outcome.at(0.0).pose, stamp, then=outcome))
