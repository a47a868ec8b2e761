"""The arm steps of firmware/bench on this computer, against the formulas in double precision."""

import ctypes

import numpy as np
import pytest

from hexarm.machines import load
from hexarm.papers.paper_arm import PaperArm, projection_rates, projections

ARM = PaperArm(0.3, 0.4, 0.35)
FLOATS = ctypes.POINTER(ctypes.c_float)


class Lengths(ctypes.Structure):
    _fields_ = (('upper', ctypes.c_float), ('fore', ctypes.c_float))


@pytest.fixture(scope='module')
def step(steps):
    library = steps
    library.resolved_rate_step.restype = ctypes.c_bool

    def call(joints, velocity, dt):
        moved = np.array(joints, np.float32)
        wanted = np.array(velocity, np.float32)
        lengths = Lengths(ARM.L2, ARM.L3)
        pointers = (a.ctypes.data_as(FLOATS) for a in (moved, wanted))
        is_regular = library.resolved_rate_step(
            ctypes.byref(lengths), *pointers, ctypes.c_float(dt)
        )
        return moved if is_regular else None

    return call


def regular_joints(count):
    rng = np.random.default_rng(4)
    while count:
        q = rng.uniform(-1.2, 1.2, 6) + np.array([0, 0.3, 1.2, 0, 1.0, 0])
        singular = np.abs(np.linalg.det(projection_rates(q)[:, 3:])) < 0.05
        across = ARM.L2 * np.sin(q[1]) + ARM.L3 * np.sin(q[1] + q[2])
        if not singular and abs(np.sin(q[2])) > 0.2 and abs(across) > 0.1:
            count -= 1
            yield q


def test_the_wrist_centre_moves_as_wanted_and_the_tool_keeps_its_direction(step):
    dt = 1e-3
    for q in regular_joints(200):
        velocity = np.array([0.05, -0.03, 0.02])
        moved = step(q, velocity, dt).astype(float)
        way = ARM.position(moved) - ARM.position(q)
        assert way == pytest.approx(velocity * dt, abs=4e-6)
        # Of second order in the step: rates of at most some rad/s, squared.
        assert projections(moved) == pytest.approx(projections(q), abs=2e-4)


def test_rates_are_those_of_the_python_formulas(step):
    dt = 1.0
    for q in regular_joints(200):
        velocity = np.array([0.05, -0.03, 0.02])
        first = np.linalg.solve(ARM.position_rates(q), velocity)
        rates = projection_rates(q)
        last = np.linalg.solve(rates[:, 3:], -rates[:, :3] @ first)
        expected = np.concatenate([first, last])
        ours = step(q, velocity, dt) - q
        assert ours == pytest.approx(expected, abs=2e-4 * max(1.0, np.abs(expected).max()))


@pytest.mark.parametrize('q', [(0, 0.3, 0, 0, 1, 0), (0, 0.5, 1.2, 0.3, 0, 0.2)])
def test_singular_joints_are_refused_and_stay(step, q):
    assert step(q, (0.1, 0, 0), 0.02) is None


def test_the_kernel_in_float_makes_the_damped_step(steps):
    arm, dt = load('arm_6r').kinematics, 0.02
    twist = np.array([0.1, -0.05, 0.02, 0.2, -0.1, 0.3])
    by_length = np.array([1 / arm.characteristic_length] * 3 + [1.0] * 3)
    for q in regular_joints(50):
        jacobian = by_length[:, None] * arm.chain.jacobian(q)
        normal = jacobian.T @ jacobian + 1e-4 * np.eye(6)
        expected = q + dt * np.linalg.solve(normal, jacobian.T @ (by_length * twist))
        chain, moved, wanted = (np.float32(a) for a in (arm.chain.numbers, q, twist))
        pointers = [a.ctypes.data_as(FLOATS) for a in (chain, moved, wanted)]
        size, time = ctypes.c_float(arm.characteristic_length), ctypes.c_float(dt)
        steps.kernel_step(pointers[0], size, *pointers[1:], time)
        assert moved == pytest.approx(expected, abs=1e-5)
