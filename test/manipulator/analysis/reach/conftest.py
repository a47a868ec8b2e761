"""One machine of each kind: cranks, linear legs, a serial arm."""

from pathlib import Path

import pytest

from hexarm.machines import load

CONFIG = Path(__file__).parents[4] / 'config'


@pytest.fixture(scope='session')
def robocake():
    return load(str(CONFIG / 'robocake.yaml'))


@pytest.fixture(scope='session')
def stewart():
    return load(str(CONFIG / 'stewart_6_3.yaml'))


@pytest.fixture(scope='session')
def arm():
    return load(str(CONFIG / 'arm_6r.yaml'))


@pytest.fixture(params=['robocake', 'stewart'])
def platform(request):
    return request.getfixturevalue(request.param)


@pytest.fixture(params=['robocake', 'stewart', 'arm'])
def machine(request):
    return request.getfixturevalue(request.param)
