from pathlib import Path

import pytest

from arm_control.load import jogging, serial_arm
from manipulator.config import build, parse_yaml
from manipulator.machine import MachineFile

CONFIG = Path(__file__).parents[2] / 'config'
ARMS = ('arm_6r', 'ur5', 'puma560')


@pytest.fixture(scope='session')
def machine_file():
    def read(name):
        return build(MachineFile, parse_yaml((CONFIG / f'{name}.yaml').read_text()), source=name)

    return read


@pytest.fixture(scope='session', params=ARMS)
def arm(request, machine_file):
    return serial_arm(machine_file(request.param))


@pytest.fixture(scope='session', params=ARMS)
def jog(request, machine_file):
    return jogging(machine_file(request.param))


@pytest.fixture(scope='session')
def arm_6r(machine_file):
    return serial_arm(machine_file('arm_6r'))
