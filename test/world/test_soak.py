"""Minutes of faults, from a seed: nothing jumps, nothing moves that was stopped, all recovers."""

import random

import numpy as np
import pytest

from bridge.driver import BoardDriver
from bridge.messages import Clear, Setpoint, Stop
from manipulator.pose import Pose

SECONDS = 60.0
GOALS = [
    Pose.from_xyz_rpy((x, y, 0.0412 + z), (0.0, 0.0, turn))
    for x, y, z, turn in (
        (0.008, 0.0, 0.0, 0.0),
        (-0.006, 0.004, 0.003, 0.1),
        (0.0, -0.006, -0.002, -0.1),
        (0.0, 0.0, 0.0, 0.0),
    )
]
PROCESSES = ('supervisor', 'inverse', 'forward', 'bridge', 'board')
JOG = np.array([0.01, -0.01, 0.005, 0.1, 0.0, 0.1])


class Faults:
    """One thing after the other that goes wrong, or that somebody asks for."""

    def __init__(self, world, seed):
        self.world, self.chance = world, random.Random(seed)

    def happen(self):
        kinds = (self.freeze, self.kill, self.pull, self.lose, self.late, self.clock, self.stop)
        self.chance.choice(kinds)()

    def freeze(self):
        getattr(self.world, self.chance.choice(PROCESSES)).freeze(self.chance.uniform(0.02, 2.0))

    def kill(self):
        self.world.restart(self.chance.choice(PROCESSES[:-1]))

    def pull(self):
        self.world.cable.pull()
        self.world.run(self.chance.uniform(0.01, 1.0))
        self.world.cable.plug()

    def lose(self):
        """A share of what one link carries is lost for a while."""
        world, share = self.world, self.chance.uniform(0.1, 1.0)
        link = self.chance.choice([*world.links.values(), *world.cable.links])
        link.loses = lambda: self.chance.random() < share
        world.run(self.chance.uniform(0.1, 2.0))
        link.loses = lambda: False

    def late(self):
        """One link carries everything late for a while."""
        link = self.chance.choice(list(self.world.links.values()))
        before, link.delay = link.delay, self.chance.uniform(0.01, 0.4)
        self.world.run(self.chance.uniform(0.1, 1.0))
        link.delay = before

    def clock(self):
        process = getattr(self.world, self.chance.choice(PROCESSES))
        process.clock_offset = self.chance.uniform(-3600.0, 3600.0)

    def stop(self):
        self.world.emergency_stop()
        self.world.run(self.chance.uniform(0.1, 1.0))


def recover(world):
    """As a user does; enabled again within a minute, whatever was."""
    end = world.now + 60.0
    while world.state != 'enabled' or world.status.mode == 'disabled':
        assert world.now < end, world.summary
        if world.state in ('stopped', 'fault'):
            world.bridge.ask(BoardDriver.clear_fault)
        elif world.state in ('disarmed', 'unclaimed'):
            world.bridge.ask(lambda driver: driver.enable(True))
        world.run(0.5)


def drive(world, chance):
    """Something to do: a goal or a stick."""
    if chance.random() < 0.7:
        world.send_goal(chance.choice(GOALS))
        world.run(chance.uniform(0.1, 1.0))
    else:
        world.jog(JOG * chance.choice([-1, 1]), chance.uniform(0.1, 0.6), 'cmd_vel/joy')


@pytest.mark.parametrize('seed', range(8))
def test_a_minute_of_faults_breaks_no_limit_and_each_is_recovered_from(make_world, seed):
    world = make_world()
    faults = Faults(world, seed)
    end = world.now + SECONDS
    while world.now < end:
        drive(world, faults.chance)
        faults.happen()
        drive(world, faults.chance)
        world.run(0.5)
        recover(world)
    assert_within_limits(world)
    assert_no_setpoint_between_stop_and_clear(world)
    world.run(1.0)
    world.wait('goal', lambda: world.go_to(GOALS[-1]).result == 'reached')


def assert_within_limits(world):
    settings = world.board.machine.board.settings
    counts, ranges = world.setpoints(), np.array(settings.count_ranges)
    assert (counts >= ranges[:, 0]).all()
    assert (counts <= ranges[:, 1]).all()
    changes = np.abs(np.diff(world.pulses(), axis=0))
    assert not (changes > np.array(settings.count_speeds) * 0.05 + 1.0).any()


def assert_no_setpoint_between_stop_and_clear(world):
    is_stopped = False
    for at, message in world.frames():
        is_stopped = isinstance(message, Stop) or (is_stopped and not isinstance(message, Clear))
        assert not (is_stopped and isinstance(message, Setpoint)), at
