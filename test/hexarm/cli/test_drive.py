"""`hexarm home` and its siblings where the machine does not move: which command comes first."""

import pytest

from hexarm.cli.main import main
from manipulator.errors import Refused


class Idle:
    """A robot that refuses to move in its state."""

    def __init__(self, state):
        self.state = state

    def __call__(self, namespace):
        return self

    def __enter__(self):
        return self

    def __exit__(self, *exception):
        return None

    def home(self):
        raise Refused(f'the machine is {self.state}')


@pytest.mark.parametrize(
    ('state', 'first'),
    [
        ('disarmed', '. First: hexarm enable arm'),
        ('stopped', '. Inspect the machine, then: hexarm clear arm'),
        ('fault', '. Inspect the machine, then: hexarm clear arm'),
        ('enabled', ''),
    ],
)
def test_a_refusal_ends_with_the_command_that_comes_first(state, first, monkeypatch, capsys):
    monkeypatch.setattr('hexarm.robot.Robot', Idle(state))
    assert main(['home', 'arm']) == 2
    assert capsys.readouterr().err == f'hexarm: the machine is {state}{first}\n'
