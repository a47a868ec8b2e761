"""What else a user may ask of a machine: what the services and topics of its nodes do."""

import numpy as np

from manipulator.errors import ManipulatorError, Refused
from manipulator.pose import Pose
from manipulator.trajectory.cycle import Cycle
from manipulator.trajectory.goal import Goal
from manipulator.trajectory.path import Tolerance
from manipulator.trajectory.path_timing import PathRequest, plan_path
from world.supervisor import DT

SWING = np.array([0.003, 0.003, 0.0015, 0.05, 0.05, 0.04])
"""Amplitudes of the cycle, m and rad: those of the node's parameters."""

TOLERANCE = Tolerance(1e-4, np.radians(0.1))


class Requests:
    """Of the motion supervisor; Refused says why something is not done."""

    def __init__(self, world):
        self._world = world

    @property
    def _pilot(self):
        return self._world.supervisor.pilot

    def stop(self):
        """trajectory/stop: brakes along the way."""
        self._pilot.player.stop()
        self._world.supervisor.teleop.stop()

    def pause(self, is_paused):
        self._pilot.pause(is_paused)

    def override(self, rate):
        self._pilot.override(rate)

    def pivot(self, point):
        self._pilot.set_pivot(point)

    def mode(self, name, point=None):
        if point is not None:
            self._world.supervisor.teleop.look_at(np.array(point))
        self._world.supervisor.teleop.set_mode(name)

    def cycle(self, amplitude=SWING, frequency=0.5, phase=0.0):
        player = self._pilot.player
        form = (np.resize(amplitude, 6), np.full(6, frequency), np.resize(phase, 6))
        player.start_cycle(Cycle(player.state.pose, *form), self._world.user.stamp)

    def home(self):
        """Goes there, at full speed; waits until it is there."""
        self.override(1.0)
        return self._world.go_to(self._world.machine.kinematics.home)

    def path(self, poses, speed=None, seconds=0.1):
        """goal_path: poses (n,), worked out in so many seconds; its stamp."""
        stamp, player = self._world.user.stamp, self._pilot.player
        fastest = self._pilot.machine.motion.linear.speed
        request = PathRequest(poses, speed or fastest, TOLERANCE)
        machine, near = self._pilot.machine, player.joints
        player.expect(stamp)

        def take():
            if self._is_expected(stamp):
                self._take_path(machine, request, near, stamp)

        self._world.timeline.after(seconds, lambda: self._world.supervisor.handle(take))
        return stamp

    def _is_expected(self, stamp):
        try:
            return self._pilot.player.expected == stamp
        except Refused:
            return False

    def _take_path(self, machine, request, near, stamp):
        player = self._pilot.player
        try:
            outcome = plan_path(machine, request, near, DT)
        except ManipulatorError as error:
            player.refuse(stamp, str(error))
            return
        if isinstance(outcome, Pose):
            player.pursue(Goal(outcome, stamp))
        else:
            player.pursue(Goal(outcome.at(0.0).pose, stamp, then=outcome))
