"""Machines in simulated time."""

import pytest

from world.world import World


@pytest.fixture
def make_world():
    """A world of a machine, enabled: `make_world('robocake')`."""

    def make(name='robocake'):
        world = World(name)
        world.enable()
        return world

    return make


@pytest.fixture
def world(make_world):
    """The hexapod's, enabled."""
    return make_world()
