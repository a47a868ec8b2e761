"""arm_inverse.c on this computer: both closed forms give the joints back."""

import ctypes
from functools import partial

import numpy as np
import pytest

from hexarm.machines import load

FLOATS = ctypes.POINTER(ctypes.c_float)
SHOULDER = np.array([0.0, 0.0, 0.3])
TOOL = 0.12
WAYS = ('algebraic', 'geometric')


class Lengths(ctypes.Structure):
    _fields_ = (('upper', ctypes.c_float), ('fore', ctypes.c_float))


@pytest.fixture
def solved(steps):
    return partial(solution, steps)


def solution(steps, way, centre, rotation):
    call = getattr(steps, f'arm_inverse_{way}')
    call.restype = ctypes.c_bool
    joints = np.zeros(6, np.float32)
    arrays = [np.ascontiguousarray(np.ravel(a), np.float32) for a in (centre, rotation)]
    pointers = (a.ctypes.data_as(FLOATS) for a in (*arrays, joints))
    return joints if call(ctypes.byref(Lengths(0.4, 0.4)), *pointers) else None


@pytest.mark.parametrize('way', WAYS)
def test_joints_of_the_branch_come_back(solved, way):
    """The shipped arm has L2 = L3 = 0.4 m; q3, q5 > 0, the wrist off the axis of joint 1."""
    chain = load('arm_6r').kinematics.chain
    joints = np.random.default_rng(5).uniform(
        [-3, -0.4, 0.4, -3, 0.3, -3], [3, 0.8, 2.0, 3, 2.6, 3], (300, 6)
    )
    for q in joints[np.sin(joints[:, 1]) + np.sin(joints[:, 1] + joints[:, 2]) > 0.1]:
        tool = chain.forward(q)
        centre = tool.position - TOOL * tool.rotation[:, 2] - SHOULDER
        assert solved(way, centre, tool.rotation) == pytest.approx(q, abs=1e-4)


@pytest.mark.parametrize('way', WAYS)
@pytest.mark.parametrize('centre', [(0.9, 0.0, 0.0), (0.0, 0.0, 0.5)])
def test_a_centre_beyond_the_arm_or_on_its_axis_is_refused(solved, way, centre):
    assert solved(way, centre, np.eye(3)) is None
