"""What ends motion at once, and that nothing resumes by itself."""

import itertools

import numpy as np
import pytest

from bridge.driver import BoardDriver
from bridge.messages import Setpoint, Stop
from manipulator.pose import Pose

FAR = Pose.from_xyz_rpy((0.010, 0.0, 0.0412))
QUIET = 2.0
"""Counts: roundings, not motion."""


def steps(world, since):
    """The largest change of a count from each frame to the next."""
    return [np.abs(b - a).max() for a, b in itertools.pairwise(world.setpoints(since))]


def test_after_stop_and_clear_nothing_moves_until_a_new_command(world):
    world.send_goal(FAR)
    world.run(0.3)
    stopped = world.now
    answer = world.emergency_stop()
    world.wait('stop', lambda: world.state == 'stopped')
    assert answer.said == ''
    assert world.status.result == 'stopped'
    said = [type(message) for _, message in world.frames(since=stopped)]
    assert Setpoint not in said[said.index(Stop) :]
    world.run(0.5)
    still = world.now
    assert world.clear() == ''
    world.wait('hold', lambda: world.status.mode == 'hold')
    world.run(0.5)
    pulses = world.pulses(still)
    assert np.nanmax(np.abs(pulses - pulses[0])) <= QUIET
    assert max(steps(world, stopped)) <= QUIET
    assert world.go_to(FAR).result == 'reached'


def test_a_stop_stands_within_a_tenth_of_a_second(world):
    world.send_goal(FAR)
    world.run(0.3)
    asked = world.now
    world.emergency_stop()
    world.run(1.0)
    pulses = world.pulses(asked + 0.1)
    assert np.nanmax(np.abs(pulses - pulses[0])) == 0.0


@pytest.mark.parametrize('lost', range(1, 5))
def test_a_stop_whose_frames_are_lost_is_said_again(world, lost):
    down, _ = world.cable.links
    left = iter([True] * lost)
    world.send_goal(FAR)
    world.run(0.3)
    down.loses = lambda: next(left, False)
    world.emergency_stop()
    world.wait('stop', lambda: world.state == 'stopped', 2.0)


def test_a_stop_while_the_cable_is_out_is_obeyed_by_the_board_that_comes_back(world):
    world.cable.pull()
    world.run(0.5)
    assert 'no board' in world.ask(BoardDriver.stop)
    world.cable.plug()
    world.wait('stop', lambda: world.state == 'stopped')
    assert not world.frames(Setpoint, since=world.now - 1.0)
