import numpy as np
import pytest
from euler import from_zxz

from hexapod_control.leg_motion import to_zxz
from manipulator import rotation as so3


def axis_turn(axis, angle):
    return so3.exp(np.eye(3)[axis] * angle)


def test_zxz_angles_are_turns_about_z_then_x_then_z():
    alpha, beta, gamma = 0.4, 1.1, -2.3
    expected = axis_turn(2, alpha) @ axis_turn(0, beta) @ axis_turn(2, gamma)
    assert np.allclose(from_zxz([alpha, beta, gamma]), expected, atol=1e-14)


def random_angles(count):
    random = np.random.default_rng(1)
    return random.uniform([-np.pi, 0.01, -np.pi], [np.pi, np.pi - 0.01, np.pi], (count, 3))


def test_angles_of_either_sign_of_beta_come_back_when_they_are_near():
    for angles in random_angles(500):
        for near in (angles, angles * [1, -1, 1]):
            assert np.allclose(to_zxz([from_zxz(near)], near + 0.002), near, atol=1e-9)


def test_angles_of_a_rotation_give_it_back_whatever_they_start_from():
    rotations = from_zxz(random_angles(100))
    for start in random_angles(5):
        assert np.allclose(from_zxz(to_zxz(rotations, start)), rotations, atol=1e-9)


def test_a_tilt_through_level_makes_no_step():
    """β goes from +0.3° through 0 to −0.3°; with β ≥ 0, α and γ would jump by half a turn."""
    tilts = np.radians(np.linspace(0.3, -0.3, 61))
    rotations = from_zxz(np.stack([0 * tilts + 0.2, tilts, 0 * tilts - 0.1], axis=1))
    found = to_zxz(rotations, (0.2, tilts[0], -0.1))
    assert np.abs(np.diff(found, axis=0)).max() < np.radians(0.011)
    assert found[-1] == pytest.approx([0.2, tilts[-1], -0.1], abs=1e-9)


def test_turns_beyond_half_a_turn_make_no_step():
    alphas = np.linspace(0, 3 * np.pi, 100)
    angles = np.stack([alphas, 0 * alphas + 0.4, -0.5 * alphas], axis=1)
    assert np.allclose(to_zxz(from_zxz(angles), angles[0]), angles, atol=1e-9)


def test_a_level_platform_keeps_alpha():
    assert np.allclose(to_zxz([np.eye(3)]), 0.0)
    assert np.allclose(to_zxz([axis_turn(2, 0.7)], (0.2, 0.0, 0.0)), [[0.2, 0.0, 0.5]])
    almost = from_zxz([0.3, 1e-8, 0.4])
    assert to_zxz([almost]) == pytest.approx(np.array([[0.0, 0.0, 0.7]]), abs=1e-7)


def test_an_upturned_platform_keeps_its_rotation():
    upturned = axis_turn(2, 0.7) @ axis_turn(0, np.pi)
    ((alpha, beta, gamma),) = to_zxz([upturned], (0.1, 3.0, 0.0))
    assert alpha == pytest.approx(0.1)
    assert beta == pytest.approx(np.pi)
    assert np.allclose(from_zxz([alpha, beta, gamma]), upturned, atol=1e-12)
