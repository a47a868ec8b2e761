"""Executors that are jogged and keep where they went, for every kind of machine and its frames."""

import itertools

import numpy as np
import pytest

from hexarm.machines import load
from manipulator.framed_machine import in_frames
from manipulator.frames import Frames
from manipulator.pose import Pose
from manipulator.teleop.jog_modes import Free
from manipulator.trajectory.executor import Executor
from manipulator.trajectory.jogging import JogCommand

DT = 0.01
FREE = Free()
FRAMES = Frames(T_base_work=Pose.from_xyz_rpy([0.01, 0.02, 0.0], [0.0, 0.0, 0.6])).with_pivot(
    [0.0, 0.01, 0.03]
)
MACHINES = {name: load(name) for name in ('robocake', 'stewart_6_3', 'arm_6r')}
MACHINES |= {f'{name} in frames': in_frames(MACHINES[name], FRAMES) for name in tuple(MACHINES)}
PLATFORMS = [name for name in MACHINES if not name.startswith('arm')]


class Jogged(Executor):
    """A executor with the poses and joints of every tick so far, those of its beginning first."""

    def __init__(self, machine, pose, joints):
        super().__init__(machine, pose, joints, DT)
        self.machine = machine
        self.poses, self.configurations = [pose], [joints]

    def run(self, ticks, twist=None, mode=FREE, frame=''):
        """Poses of these ticks, the present one first; without a twist nobody jogs."""
        begin = len(self.poses) - 1
        command = None
        if twist is not None:
            command = JogCommand('cmd_vel/joy', np.array(twist, dtype=float), frame, mode)
        for _ in range(ticks):
            self.jog(command)
            self.poses.append(self.step())
            self.configurations.append(self.joints)
        return self.poses[begin:]

    def run_to_the_edge(self, twist, frame=''):
        """Until the machine hardly moves any more."""
        self.run(3, twist, frame=frame)
        for _ in range(1000):
            if np.abs(self.poses[-2].twist_to(self.poses[-1])).max() <= 1e-5:
                return
            self.run(1, twist, frame=frame)

    def check_limits(self):
        """By differences: joints, tool or platform speed, every configuration inside.

        A parallel platform also keeps its own acceleration; an arm's joints may need to brake
        harder before a stop than its tool would.
        """
        motion, joints = self.machine.motion, np.array(self.configurations)
        speed = np.diff(joints, axis=0) / DT
        assert (np.abs(speed) <= 1.01 * motion.joint.speed).all()
        assert (np.abs(np.diff(speed, axis=0)) / DT <= 1.01 * motion.joint.acceleration).all()
        twists = self.twists
        assert np.linalg.norm(twists[:, :3], axis=1).max() <= 1.02 * motion.linear.speed
        assert np.linalg.norm(twists[:, 3:], axis=1).max() <= 1.02 * motion.angular.speed
        for pose, q in zip(self.poses, joints, strict=True):
            self.machine.constraints.check(pose, q)
            assert np.abs(self.machine.kinematics.inverse(pose, q) - q).max() < 1e-6

    @property
    def twists(self):
        """From each pose to the next, m/s and rad/s."""
        return np.array([a.twist_to(b) for a, b in itertools.pairwise(self.poses)]) / DT

    @property
    def full_speed(self):
        """The fastest part of a twist in each direction, m/s and rad/s."""
        motion = self.machine.motion
        return np.repeat([motion.linear.speed, motion.angular.speed], 3)


@pytest.fixture(scope='session', params=MACHINES)
def machine(request):
    return MACHINES[request.param]


@pytest.fixture(scope='session', params=PLATFORMS)
def platform(request):
    return MACHINES[request.param]


@pytest.fixture(scope='session')
def at_home():
    """Makes a executor that holds its machine at home."""

    def make(machine):
        home = machine.kinematics.home
        return Jogged(machine, home, machine.kinematics.inverse(home))

    return make


@pytest.fixture(scope='session')
def standing():
    """Makes a executor that holds its machine where it is told that it stands."""
    return Jogged
