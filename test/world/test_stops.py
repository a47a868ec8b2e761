"""What ends motion at once, and that nothing resumes by itself."""

import numpy as np
import pytest

from bridge.driver import BoardDriver
from bridge.protocol import Clear, Setpoint, Stop
from manipulator.pose import Pose

FAR = Pose.from_xyz_rpy((0.010, 0.0, 0.0412))
QUIET = 2.0
"""Counts: roundings, not motion."""


def test_after_stop_and_clear_nothing_moves_until_a_new_command(world):
    world.send_goal(FAR)
    world.run(0.12)
    stopped = world.now
    answer = world.emergency_stop()
    world.wait('stop', lambda: world.state == 'stopped')
    assert answer.said == ''
    assert world.status.result == 'stopped'
    text = [type(message) for _, message in world.frames(since=stopped)]
    assert Setpoint not in text[text.index(Stop) :]
    world.run(0.5)
    still = world.now
    assert world.clear() == ''
    world.wait('hold', lambda: world.status.mode == 'hold')
    world.run(0.5)
    assert world.moved(still) <= QUIET
    assert max(world.steps(stopped)) <= QUIET
    assert world.go_to(FAR).result == 'reached'


def test_a_stop_stands_within_a_tenth_of_a_second(world):
    world.send_goal(FAR)
    world.run(0.12)
    asked = world.now
    world.emergency_stop()
    world.run(1.0)
    assert world.moved(asked + 0.1) == 0.0


@pytest.mark.parametrize('lost', range(1, 5))
def test_a_stop_whose_frames_are_lost_is_repeated(world, lost):
    down, _ = world.cable.links
    left = iter([True] * lost)
    world.send_goal(FAR)
    world.run(0.12)
    down.loses = lambda: next(left, False)
    world.emergency_stop()
    world.wait('stop', lambda: world.state == 'stopped', 2.0)


def test_a_stop_while_the_cable_is_out_is_obeyed_by_the_board_that_comes_back(world):
    world.cable.pull()
    world.run(0.5)
    assert 'no board' in world.ask(BoardDriver.stop)
    world.cable.plug()
    plugged_at = world.now
    world.wait('stop', lambda: world.state == 'stopped')
    assert not world.frames(Setpoint, since=plugged_at)


def test_a_hammered_stop_holds_and_only_a_clear_ends_it(world, ask):
    ask.cycle()
    world.run(1.0)
    for _ in range(200):
        world.emergency_stop()
        world.run(0.002)
    world.wait('stop', lambda: world.state == 'stopped')
    since = world.now
    arming = world.ask_to_arm()
    world.run(1.0)
    assert 'clear the stop first' in arming.said
    assert world.moved(since) <= QUIET
    assert not world.frames((Clear, Setpoint), since)
    assert world.state == 'stopped'
    assert world.clear() == ''
    world.wait('hold', lambda: world.status.mode == 'hold')
    assert world.go_to(FAR).result == 'reached'


def test_hammering_stop_and_clear_leaves_a_machine_that_works(world):
    for k in range(100):
        world.send_goal(FAR)
        if k % 2:
            world.emergency_stop()
        else:
            world.bridge.ask(BoardDriver.clear_fault)
        world.run(0.013)
    world.wait('stop', lambda: world.state == 'stopped')
    assert world.clear() == ''
    world.wait('hold', lambda: world.status.mode == 'hold')
    assert world.go_to(FAR).result == 'reached'


def test_a_goal_from_before_the_clear_is_refused_and_moves_nothing_afterwards(world):
    world.emergency_stop()
    world.wait('stop', lambda: world.state == 'stopped')
    refused = world.go_to(FAR)
    assert (refused.result, 'clear the stop first' in refused.reason) == ('refused', True)
    assert world.clear() == ''
    world.wait('hold', lambda: world.status.mode == 'hold')
    since = world.now
    world.run(1.0)
    assert world.moved(since) <= QUIET


def test_a_stop_along_the_path_brakes_and_the_next_goal_is_driven(world, ask):
    stamp = world.send_goal(FAR)
    world.run(0.12)
    ask.stop()
    assert world.status.result == 'moving'
    world.wait('rest', lambda: world.status.result == 'stopped')
    assert world.status.goal_stamp == stamp
    assert 0.001 < world.pose.position[0] < 0.009
    assert world.state == 'enabled'
    assert world.go_to(FAR).result == 'reached'


def test_a_stop_that_board_and_bridge_have_lost_leaves_a_machine_that_nothing_moves(world):
    world.send_goal(FAR)
    world.run(0.12)
    world.cable.pull()
    world.run(0.5)
    world.ask(BoardDriver.stop)
    world.restart('bridge')
    world.cable.plug()  # the board is reset
    world.wait('board', lambda: world.state == 'disarmed')
    world.run(1.0)
    assert np.isnan(world.pulses(world.now - 0.5)).all()
    assert not world.frames(Setpoint, since=world.now - 1.0)


def test_a_board_keeps_a_stop_for_the_next_bridge(world):
    world.emergency_stop()
    world.wait('stop', lambda: world.state == 'stopped')
    world.restart('bridge')
    world.wait('stop', lambda: world.state == 'stopped')
    assert 'clear the stop first' in world.ask(lambda driver: driver.enable(True))
    assert world.clear() == ''
