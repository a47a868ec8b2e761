"""Machines in simulated time."""

import pytest

from world.requests import Requests
from world.world import World


@pytest.fixture
def make_world():
    """A world of a machine, enabled: `make_world('robocake')`."""

    def make(name='robocake', hysteresis=None):
        world = World(name, hysteresis=hysteresis)
        world.enable()
        return world

    return make


@pytest.fixture
def world(make_world):
    """The hexapod's, enabled."""
    return make_world()


@pytest.fixture
def ask(world):
    """What else its user may ask of the hexapod."""
    return Requests(world)
