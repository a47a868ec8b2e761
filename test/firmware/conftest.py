"""The simulated board with a host that talks to it, for what only a chip can show."""

import pytest

from firmware.simulator.host import Host


@pytest.fixture(scope='session', autouse=True)
def tools(chip_tools):
    """Nothing here goes without them."""


@pytest.fixture
def host():
    """A board that has just been switched on."""
    return Host()


@pytest.fixture
def armed(host):
    """A board whose servos are all on, at PARK."""
    host.arm()
    return host
