"""The RoboCake as its machine file describes it."""

from pathlib import Path

import pytest

from hexapod_control.load import hexapod
from manipulator.config import build, parse_yaml
from manipulator.machine import MachineFile

ROBOCAKE = Path(__file__).parents[2] / 'config' / 'robocake.yaml'


@pytest.fixture
def robocake_content():
    return parse_yaml(ROBOCAKE.read_text())


@pytest.fixture(scope='session')
def robocake():
    return hexapod(build(MachineFile, parse_yaml(ROBOCAKE.read_text())))
