"""Faults, from a seed: nothing jumps, nothing moves that was stopped, all recovers."""

import contextlib
import os
import random

import numpy as np
import pytest

from bridge.driver import BoardDriver
from bridge.protocol import Clear, Setpoint, Stop
from manipulator.errors import Refused
from sampling import enough
from world.faulty_line import FaultyLine
from world.requests import Requests

SECONDS = float(os.environ.get('SOAK_SECONDS', '20'))
"""Of simulated time, for each seed."""

PER_MINUTE = 2400.0
"""Faults of the line and the board, while there is a storm of them."""

PROCESSES = ('controller', 'inverse', 'forward', 'bridge', 'board')
WAYS = [(0.8, 0.0, 0.0, 0.0), (-0.6, 0.4, 0.3, 0.1), (0.0, -0.6, -0.2, -0.1), (0.0, 0.0, 0.0, 0.0)]
"""Goals: x, y, z as shares of the reach, and a turn about z, from home."""

MACHINES = {'robocake': (0.010, 0.010), 'arm_6r': (0.04, 0.1), 'arm_6r_stepper': (0.04, 0.1)}
"""How far each is moved along an axis (m), and how fast it is jogged (m/s)."""


class Faults:
    """One thing after the other that goes wrong, or that somebody asks for."""

    def __init__(self, world, seed):
        self.world, self.chance = world, random.Random(seed)
        self.line = FaultyLine(world, seed, PER_MINUTE)
        self.happened = 0

    @property
    def count(self):
        return self.happened + self.line.count

    def happen(self):
        kinds = (self.freeze, self.kill, self.pull, self.lose, self.late, self.clock, self.stop)
        self.chance.choice((*kinds, *3 * [self.storm]))()
        self.happened += 1

    def storm(self):
        self.line.storm(self.chance.uniform(0.5, 5.0))

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


class Hand:
    """Has something to do: a goal, a stick, a cycle, a path's stop, another speed."""

    def __init__(self, world, name, chance):
        self.world, self.chance, self.ask = world, chance, Requests(world)
        self.reach, self.speed = MACHINES[name]

    def act(self):
        doing = self.chance.choices(
            (self.goal, self.jog, self.cycle, self.stop, self.override), (6, 2, 1, 1, 1)
        )
        with contextlib.suppress(Refused):
            doing[0]()
        self.world.run(self.chance.uniform(0.1, 1.0))

    def goal(self):
        *way, turn = self.chance.choice(WAYS)
        self.world.send_goal(self.near_home(way, turn))

    def near_home(self, way, turn=0.0):
        twist = [*(self.reach * np.array(way)), 0.0, 0.0, turn]
        return self.world.machine.kinematics.home.moved(np.array(twist))

    def jog(self):
        twist = self.speed * self.chance.choice([-1, 1]) * np.array([1, -1, 0.5, 5, 0, 5])
        self.world.jog(twist, self.chance.uniform(0.1, 0.6), 'cmd_vel/joy')

    def cycle(self):
        self.ask.cycle()

    def stop(self):
        self.ask.stop()

    def override(self):
        self.ask.override(self.chance.choice([0.3, 1.0]))


@pytest.mark.parametrize(
    ('name', 'seed'),
    [*(('robocake', seed) for seed in range(enough(3, 6))), ('arm_6r', 6), ('arm_6r_stepper', 8)],
)
def test_faults_break_no_limit_and_each_is_recovered_from(make_world, name, seed):
    world = make_world(name)
    faults = Faults(world, seed)
    hand = Hand(world, name, faults.chance)
    end = world.now + SECONDS
    while world.now < end:
        hand.act()
        faults.happen()
        hand.act()
        world.run(0.5)
        recover(world)
    print(f'{faults.count} faults in {world.now - end + SECONDS:.0f} s')
    assert faults.count > SECONDS / 3
    assert_within_limits(world)
    assert_no_setpoint_between_stop_and_clear(world)
    hand.ask.override(1.0)
    world.run(1.0)
    world.wait('goal', lambda: world.go_to(hand.near_home((0, 0, 0))).result == 'reached')


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
