"""The simulated board with a host that talks to it, for what only a chip can show."""

import os

import pytest

from firmware.simulator.host import Host
from hexarm import firmware_build


@pytest.fixture(scope='session', autouse=True)
def tools():
    """Skips where the tools are missing, unless nothing may be skipped."""
    missing = firmware_build.missing_tools()
    if missing and os.environ.get('REQUIRE_ALL') != '1':
        pytest.skip(f'not installed: {", ".join(missing)}')


@pytest.fixture
def host():
    """A board that has just been switched on."""
    return Host()


@pytest.fixture
def armed(host):
    """A board whose servos are all on, at PARK."""
    host.arm()
    return host
