"""Machines as loaded, and the crank machine with the limits that the reference figures have."""

import dataclasses

import numpy as np
import pytest

from hexarm.machines import load
from manipulator.limits.constraints import Constraints
from manipulator.limits.machine_limits import BodyHeight, JointRange


@pytest.fixture(scope='session')
def robocake():
    return load('robocake')


@pytest.fixture(scope='session')
def stewart():
    return load('stewart_6_3')


@pytest.fixture(scope='session')
def above_the_cranks(robocake):
    """A maker of the machine with rods, a range of crank angles (deg) and z ≥ 0 alone."""

    def make(low=None, high=None):
        limits = [
            limit for limit in robocake.constraints.limits if limit.quantity.startswith('rod')
        ]
        limits.append(BodyHeight(0.0))
        if low is not None:
            ends = (np.full(6, np.radians(end)) for end in (low, high))
            limits.append(JointRange(*ends, tuple(f'leg {k}' for k in range(1, 7))))
        return dataclasses.replace(robocake, constraints=Constraints(tuple(limits)))

    return make
