"""What tests of every folder may ask for."""

import os

import pytest

from hexarm import firmware_build


@pytest.fixture(scope='session')
def chip_tools():
    """The board's compiler and its simulated chip; skips without, if anything may be."""
    missing = firmware_build.missing_tools()
    if missing and os.environ.get('REQUIRE_ALL') != '1':
        pytest.skip(f'not installed: {", ".join(missing)}')
