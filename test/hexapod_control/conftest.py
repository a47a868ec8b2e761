"""The RoboCake as its machine file describes it."""

from pathlib import Path

import numpy as np
import pytest

from hexapod_control import load
from hexapod_control.workspace import sample
from manipulator.config import build, parse_yaml
from manipulator.machine import MachineFile
from sampling import enough

ROBOCAKE = Path(__file__).parents[2] / 'config' / 'robocake.yaml'


@pytest.fixture
def robocake_content():
    return parse_yaml(ROBOCAKE.read_text())


@pytest.fixture(scope='session')
def robocake():
    return load.hexapod(build(MachineFile, parse_yaml(ROBOCAKE.read_text())))


@pytest.fixture(scope='session')
def hexapod(robocake):
    return robocake.kinematics


@pytest.fixture(scope='session')
def many(robocake):
    """Poses of the whole workspace."""
    return sample(robocake, enough(3000, 10_000), np.random.default_rng(1))


@pytest.fixture(scope='session')
def stewart_content():
    """A function from a linear machine's name to the content of its file."""
    return lambda name: parse_yaml((ROBOCAKE.parent / f'{name}.yaml').read_text())
