"""The simulated board with a host that talks to it, for what only a chip can show."""

import ctypes
import subprocess

import pytest

import build_backend
from firmware.simulator.host import Host

BENCH = build_backend.ROOT / 'firmware' / 'bench'
STRICT = ('-Wall', '-Wextra', '-Wconversion', '-Wdouble-promotion', '-Werror', '-O2')


@pytest.fixture(scope='session', autouse=True)
def tools(chip_tools):
    """Nothing here goes without them."""


@pytest.fixture(scope='session')
def steps(tmp_path_factory):
    """What firmware/bench measures on the chip, compiled for this computer."""
    library = tmp_path_factory.mktemp('bench') / 'steps.so'
    sources = [str(path) for path in BENCH.glob('*.c') if path.name != 'bench.c']
    command = [*build_backend.compiler(), *build_backend.FLAGS, *STRICT, *sources, '-lm']
    subprocess.run([*command, '-o', str(library)], check=True)
    return ctypes.CDLL(str(library))


@pytest.fixture
def host():
    """A board that has just been switched on."""
    return Host()


@pytest.fixture
def armed(host):
    """A board whose servos are all on, at PARK."""
    host.arm()
    return host
