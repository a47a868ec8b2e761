import pytest

from hexarm.machines import load


@pytest.fixture(scope='session')
def arm_6r():
    """Fadeev and Loginov's arm."""
    return load('arm_6r').kinematics
