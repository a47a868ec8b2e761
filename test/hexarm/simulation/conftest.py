"""The shipped machines with their masses."""

import pytest

from hexarm import machines
from hexarm.simulation.model import mechanism
from hexarm.simulation.simulation import Simulation

NAMES = ('robocake', 'stewart_6_3', 'stewart_6_6', 'arm_6r', 'ur5')


class Example:
    """One shipped machine: its file, its kinematics and limits, its model at home."""

    def __init__(self, name):
        self.name = name
        self.file = machines.read(name)
        self.machine = machines.load(name)
        self.kinematics = self.machine.kinematics
        self.mechanism = mechanism(name, self.file, self.kinematics)

    def simulation(self, pose=None, **changes):
        model = mechanism(self.name, self.file, self.kinematics, **changes)
        pose = self.kinematics.home if pose is None else pose
        return Simulation(model, pose, self.kinematics.inverse(pose))


@pytest.fixture(scope='session')
def example():
    """A function from a machine's name to an Example, made once."""
    made = {}

    def of(name):
        if name not in made:
            made[name] = Example(name)
        return made[name]

    return of
