"""The demonstration's moves on a computer that stands still now and then."""

import pytest

from hexarm.cli.demo import drive
from manipulator.errors import Refused, Stopped, TimedOut
from manipulator.pose import Pose

GOAL = Pose.from_xyz_rpy((0.0, 0.0, 0.049))


class StallingClient:
    """Fails in turn with what it is given, then reaches its goals."""

    def __init__(self, *failures):
        self.failures = list(failures)
        self.goals = []

    def wait(self, what, is_so, seconds):
        assert is_so()

    def motion(self, key):
        return 'hold'

    def go_to(self, goal):
        self.goals.append(goal)
        if self.failures:
            raise self.failures.pop(0)


def test_a_machine_that_stopped_or_was_not_ready_is_asked_again(capsys):
    client = StallingClient(Stopped('stopped: setpoints stood still'), Refused('pose not known'))
    drive(client, GOAL)
    assert client.goals == [GOAL] * 3
    assert capsys.readouterr().out.count('once more') == 2


def test_a_refusal_that_was_to_be_expected_is_not_asked_for_again():
    client = StallingClient(TimedOut('no answer'), Refused('out of reach'))
    with pytest.raises(Refused, match='out of reach'):
        drive(client, GOAL, is_possible=False)
    assert client.goals == [GOAL] * 2


def test_a_goal_that_fails_three_times_is_given_up():
    client = StallingClient(*[Refused(f'try {k}') for k in range(3)])
    with pytest.raises(Refused, match='try 2'):
        drive(client, GOAL)
