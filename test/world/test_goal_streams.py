"""Streams of goals, 15 to 100 a second: followed as smoothly as they come."""

import itertools

import numpy as np
import pytest

from world.controller import DT

SMOOTH = 1.3
"""Times the acceleration of the stream itself, at most."""

SETTLED = 1.2
"""Seconds after which the stream swings with its full amplitude."""


class Commanded:
    """Setpoints of a world from now on, beside the user's sine along or about one axis."""

    def __init__(self, world, axis, amplitude, frequency):
        self.world, self.axis = world, axis
        self.home = world.machine.kinematics.home
        self.begin = world.now
        self.amplitude, self.frequency = amplitude, frequency
        self.poses, self.times = [], []
        send = world.controller._setpoints.send

        def keep(stamp, pose):
            self.poses.append(pose)
            self.times.append(world.now - self.begin)
            send(stamp, pose)

        world.controller._setpoints.send = keep

    def sine(self, times):
        share = np.clip(np.asarray(times), 0.0, 1.0)
        rise = share**3 * (10.0 - 15.0 * share + 6.0 * share**2)
        return self.amplitude * rise * np.sin(2 * np.pi * self.frequency * np.asarray(times))

    def stream(self, seconds, rate, late=0.0, is_even=False):
        """Goals, each sent up to `late` periods later than it should be, which its stamp says.

        is_even: it is nevertheless the pose of when it should have been sent.
        """
        rng, count = np.random.default_rng(1), 0
        while self.world.now < self.begin + seconds:
            now = self.world.now - self.begin
            at = self.sine(count / rate if is_even else now)
            self.world.send_goal(self.home.moved(at * np.eye(6)[self.axis]))
            count += 1
            due = (count + late * rng.uniform()) / rate
            self.world.run(max(due - now, 1e-3))

    @property
    def twists(self):
        return np.array([a.twist_to(b) for a, b in itertools.pairwise(self.poses)]) / DT

    @property
    def accelerations(self):
        """Along or about the axis, once the stream has its full amplitude."""
        changes = np.diff(self.twists[:, self.axis]) / DT
        return changes[np.array(self.times)[2:] > SETTLED]

    def distance(self, lag):
        """The largest from the stream as it was `lag` seconds ago."""
        late = np.array(self.times) > SETTLED
        found = np.array([self.home.twist_to(pose)[self.axis] for pose in self.poses])
        return np.abs(found - self.sine(np.array(self.times) - lag))[late].max()


@pytest.mark.parametrize(
    ('name', 'axis', 'amplitude', 'frequency', 'rate', 'late', 'lag'),
    [
        ('robocake', 0, 0.005, 1.0, 60.0, 0.0, 0.04),
        ('robocake', 0, 0.005, 0.3, 60.0, 0.6, 0.04),
        ('robocake', 5, 0.05, 0.7, 30.0, 0.0, 0.07),
        ('robocake', 0, 0.005, 0.5, 15.0, 0.0, 0.154),
        ('stewart_6_6', 2, 0.002, 0.5, 100.0, 0.0, 0.04),
        ('arm_6r', 0, 0.02, 0.5, 60.0, 0.3, 0.04),
    ],
)
def test_a_smooth_stream_is_followed_as_smoothly(
    make_world, name, axis, amplitude, frequency, rate, late, lag
):
    commanded = Commanded(make_world(name), axis, amplitude, frequency)
    commanded.stream(2.6, rate, late)
    ideal = amplitude * (2 * np.pi * frequency) ** 2
    assert np.abs(commanded.accelerations).max() < SMOOTH * ideal
    assert commanded.distance(lag) < 0.06 * amplitude


@pytest.mark.parametrize('frequency', [0.3, 1.0])
def test_a_stream_without_stamps_is_followed_as_smoothly_however_late_its_goals_come(
    world, frequency
):
    commanded, rng = Commanded(world, 0, 0.005, frequency), np.random.default_rng(1)
    link = world.links['goals']
    for k in range(156):
        link.delay = 0.005 * rng.uniform()
        now = world.now - commanded.begin
        link.send(0.0, commanded.home.moved(commanded.sine(now) * np.eye(6)[0]))
        world.run(commanded.begin + (k + 1) / 60 - world.now)
    ideal = 0.005 * (2 * np.pi * frequency) ** 2
    assert np.abs(commanded.accelerations).max() < SMOOTH * ideal
    assert commanded.distance(0.04) < 0.06 * 0.005


@pytest.mark.parametrize('is_even', [False, True])
def test_a_stream_stays_smooth_though_goals_are_lost_and_stamps_are_not_exact(world, is_even):
    rng, link = np.random.default_rng(2), world.links['goals']
    link.loses = lambda: rng.uniform() < 0.04
    commanded = Commanded(world, 0, 0.005, 0.5)
    commanded.stream(3.2, 60.0, 0.3, is_even)
    assert np.abs(commanded.accelerations).max() < SMOOTH * 0.005 * np.pi**2
    assert commanded.distance(0.04) < 0.06 * 0.005


def test_the_play_of_measured_joints_is_taken_up_as_smoothly(make_world):
    world = make_world('arm_6r_stepper', np.radians(2.0))
    commanded = Commanded(world, 2, 0.03, 0.5)
    commanded.stream(3.2, 60.0)
    assert np.abs(commanded.accelerations).max() < SMOOTH * 0.03 * np.pi**2


def test_a_circle_near_the_limits_is_followed_as_smoothly_from_its_beginning(make_world):
    world, radius = make_world('arm_6r'), 0.028
    commanded = Commanded(world, 0, 0.0, 0.5)

    def offset(time):
        share, angle = min(time, 1.0), np.pi * time
        rise = share**3 * (10.0 - 15.0 * share + 6.0 * share**2)
        return radius * rise * np.array([np.sin(angle), 1.0 - np.cos(angle), 0, 0, 0, 0])

    while world.now < commanded.begin + 2.5:
        world.send_goal(commanded.home.moved(offset(world.now - commanded.begin)))
        world.run(1 / 60)
    rows = np.array([offset(k * DT)[:3] for k in range(250)])
    ideal = np.linalg.norm(np.diff(rows, 2, axis=0), axis=1).max() / DT**2
    changes = np.diff(commanded.twists[:, :3], axis=0) / DT
    assert np.linalg.norm(changes, axis=1).max() < SMOOTH * ideal


@pytest.mark.parametrize('name', ['robocake', 'arm_6r'])
def test_a_stream_that_ends_in_motion_is_reached_within_the_limits(make_world, name):
    world = make_world(name)
    motion = world.machine.motion
    speed = 0.8 * motion.linear.speed
    commanded = Commanded(world, 0, 0.5 * speed, 0.3)
    commanded.stream(1.6, 60.0)
    last = commanded.home.moved(commanded.sine(world.now - commanded.begin) * np.eye(6)[0])
    assert world.go_to(last).result == 'reached'
    assert np.abs(commanded.poses[-1].twist_to(last)).max() < 1e-9
    twists = commanded.twists
    changes = np.diff(twists, axis=0) / DT
    assert np.linalg.norm(twists[:, :3], axis=1).max() <= 1.01 * motion.linear.speed
    assert np.linalg.norm(changes[:, :3], axis=1).max() <= 1.01 * motion.linear.acceleration


def test_a_stream_that_is_too_fast_is_pursued_within_the_limits(world):
    motion = world.machine.motion
    commanded = Commanded(world, 0, 0.008, 2.0)
    commanded.stream(2.6, 60.0)
    changes = np.diff(commanded.twists, axis=0) / DT
    assert np.linalg.norm(commanded.twists[:, :3], axis=1).max() <= 1.01 * motion.linear.speed
    assert np.linalg.norm(changes[:, :3], axis=1).max() <= 1.01 * motion.linear.acceleration
    assert np.abs(commanded.accelerations).max() > 0.5 * motion.linear.acceleration


@pytest.mark.parametrize('name', ['robocake', 'ur5'])
def test_a_stream_of_joint_goals_is_followed_as_smoothly(make_world, name):
    world = make_world(name)
    begin, rows, times = world.now, [], []
    names, home = world.machine.kinematics.joint_names, world.joints
    send = world.controller._setpoints.send

    def keep(stamp, pose):
        rows.append(world.controller.supervisor.executor.joints)
        times.append(world.now - begin)
        send(stamp, pose)

    def offset(time):
        share = np.clip(time, 0.0, 1.0)
        return 0.05 * share**3 * (10.0 - 15.0 * share + 6.0 * share**2) * np.sin(np.pi * time)

    world.controller._setpoints.send = keep
    ways = np.array([1.0, 0.5, -0.5, 0.3, 0.6, -0.4])
    while world.now < begin + 2.5:
        joints = home + offset(world.now - begin) * ways
        world.send_goal_joints(**dict(zip(names, joints, strict=True)))
        world.run(1 / 60)
    ideal = np.abs(np.diff(offset(np.arange(0.0, 2.5, DT)), 2)).max() / DT**2
    changes = np.diff(np.array(rows), 2, axis=0) / DT**2
    assert (np.abs(changes).max(axis=0) < SMOOTH * ideal * np.abs(ways)).all()
    late = np.array(rows) - home - offset(np.array(times) - 0.1)[:, None] * ways
    assert np.abs(late[60:]).max() < 0.1 * 0.05
