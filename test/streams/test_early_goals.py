"""A goal that comes right behind a *clear* or an *enable* is driven, whatever the moment."""

import pytest

from bridge.messages import Clear, Stop
from manipulator.errors import Refused
from manipulator.pose import Pose
from manipulator.trajectory.early_command import EarlyCommand
from manipulator.trajectory.goal import Goal


@pytest.fixture
def stopped(loop_of):
    """A machine under a STOP."""
    loop = loop_of('robocake')
    loop.early = EarlyCommand()
    loop.ask(Stop())
    loop.until('stopped')
    return loop


def ask(loop, goal):
    loop.early.take(
        lambda: loop.pilot.player.pursue(goal),
        lambda error: loop.refusals.append(str(error)),
        loop.now,
    )


def run(loop, ticks):
    for _ in range(ticks):
        loop.run(1)
        loop.early.poll(loop.now)


@pytest.mark.parametrize('ticks_later', range(6))
def test_a_goal_is_reached_that_comes_at_once_after_the_machine_was_cleared(stopped, ticks_later):
    stopped.ask(Clear())
    stopped.until('enabled')
    run(stopped, ticks_later)
    goal = Goal(Pose.from_xyz_rpy((0.0, 0.0, 0.049)), 5.0)
    ask(stopped, goal)
    run(stopped, 300)
    status = stopped.pilot.status
    assert (status.result, status.goal_stamp, stopped.refusals) == ('reached', 5.0, [])


def test_a_goal_from_before_the_clear_moves_nothing(stopped):
    with pytest.raises(Refused, match='clear the stop first'):
        ask(stopped, Goal(Pose.from_xyz_rpy((0.0, 0.0, 0.049)), 5.0))
    before = stopped.board.pulses
    stopped.ask(Clear())
    stopped.until('enabled')
    run(stopped, 100)
    assert stopped.board.pulses == before


def test_a_goal_that_waits_is_dropped_by_a_stop(stopped):
    stopped.ask(Clear())
    stopped.until('enabled')
    ask(stopped, Goal(Pose.from_xyz_rpy((0.0, 0.0, 0.049)), 5.0))
    before = stopped.board.pulses
    stopped.ask(Stop())
    run(stopped, 20)
    stopped.ask(Clear())
    run(stopped, 100)
    assert stopped.refusals == ['the machine is stopped: clear the stop first']
    assert stopped.board.pulses == before
