import numpy as np
import pytest

from hexapod_control.leg_motion import from_zxz, to_zxz
from manipulator import rotation as so3


def axis_turn(axis, angle):
    return so3.exp(np.eye(3)[axis] * angle)


def test_zxz_angles_are_turns_about_z_then_x_then_z():
    alpha, beta, gamma = 0.4, 1.1, -2.3
    expected = axis_turn(2, alpha) @ axis_turn(0, beta) @ axis_turn(2, gamma)
    assert np.allclose(from_zxz([alpha, beta, gamma]), expected, atol=1e-14)


def test_angles_come_back():
    random = np.random.default_rng(1)
    angles = random.uniform([-np.pi, 0.01, -np.pi], [np.pi, np.pi - 0.01, np.pi], (500, 3))
    assert np.allclose(to_zxz(from_zxz(angles)), angles, atol=1e-9)


def test_a_level_platform_has_no_gamma():
    assert np.allclose(to_zxz(np.eye(3)), 0.0)
    assert np.allclose(to_zxz(axis_turn(2, 0.7)), [0.7, 0.0, 0.0])
    almost = from_zxz([0.3, 1e-8, 0.4])
    assert to_zxz(almost) == pytest.approx([0.7, 1e-8, 0.0], abs=1e-12)


def test_an_upturned_platform_keeps_its_rotation():
    upturned = axis_turn(2, 0.7) @ axis_turn(0, np.pi)
    alpha, beta, gamma = to_zxz(upturned)
    assert gamma == 0.0
    assert beta == pytest.approx(np.pi)
    assert np.allclose(from_zxz([alpha, beta, gamma]), upturned, atol=1e-12)
