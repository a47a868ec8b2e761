import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from manipulator import rotation as so3
from manipulator.errors import InvalidInput

small = st.floats(-3, 3)
vectors = st.tuples(small, small, small).map(np.array)


def series(w):
    """exp(w) by its power series: the definition."""
    term, total = np.eye(3), np.eye(3)
    for k in range(1, 60):
        term = term @ so3.skew(w) / k
        total = total + term
    return total


@given(vectors, vectors)
def test_skew_is_the_cross_product(a, b):
    np.testing.assert_allclose(so3.skew(a) @ b, np.cross(a, b), atol=1e-12)


@given(vectors)
def test_exp_is_the_power_series(w):
    np.testing.assert_allclose(so3.exp(w), series(w), atol=1e-9)


@pytest.mark.parametrize('size', [0.0, 1e-300, 1e-12, 1e-7, 1e-6, 1e-5, 3e-4, 1e-3])
def test_small_rotations_are_exact(size):
    w = np.array([0.6, -0.8, 0.0]) * size
    np.testing.assert_allclose(so3.exp(w), series(w), atol=1e-15)
    np.testing.assert_allclose(so3.log(so3.exp(w)), w, rtol=1e-9, atol=1e-16)


@given(vectors)
def test_log_gives_the_shortest_vector_of_the_same_rotation(w):
    back = so3.log(so3.exp(w))
    assert np.linalg.norm(back) <= np.pi + 1e-12
    np.testing.assert_allclose(so3.exp(back), so3.exp(w), atol=1e-9)


@pytest.mark.parametrize('axis', [[1, 0, 0], [0, 1, 0], [0, 0, 1], [0.6, -0.8, 0]])
def test_half_turns_have_a_log(axis):
    w = np.pi * np.array(axis, dtype=float)
    np.testing.assert_allclose(so3.exp(so3.log(so3.exp(w))), so3.exp(w), atol=1e-12)


@given(vectors, vectors)
def test_left_jacobian_is_the_angular_velocity_of_exp(w, rate):
    h = 1e-6
    change = so3.exp(w + h * rate) @ so3.exp(w - h * rate).T
    np.testing.assert_allclose(so3.log(change) / (2 * h), so3.left_jacobian(w) @ rate, atol=1e-5)


@pytest.mark.parametrize('size', [0.0, 1e-6, 0.0099, 0.0101, 1.0, 3.1])
def test_turning_is_the_change_of_exp_and_its_change(size):
    """By differences of matrices: of Ṙ Rᵀ, whose antisymmetric part is ω ×."""
    rng, h = np.random.default_rng(2), 1e-4
    for start, rate, bend in rng.normal(size=(20, 3, 3)):
        start = size * start / np.linalg.norm(start)  # noqa: PLW2901

        def at(t, start=start, rate=rate, bend=bend):
            return so3.exp(start + rate * t + bend * t**2 / 2)

        def omega(t, at=at):
            return so3.log(at(t + h) @ at(t - h).T) / (2 * h)

        found = so3.turning(start, rate, bend)
        np.testing.assert_allclose(found[0], omega(0.0), atol=1e-6)
        np.testing.assert_allclose(found[1], (omega(h) - omega(-h)) / (2 * h), atol=1e-5)
        np.testing.assert_allclose(found[0], so3.left_jacobian(start) @ rate, atol=1e-14)


@given(vectors)
def test_quaternions_come_back(w):
    matrix = so3.exp(w)
    q = so3.to_quaternion(matrix)
    assert q[3] >= 0
    np.testing.assert_allclose(so3.from_quaternion(q), matrix, atol=1e-12)
    np.testing.assert_allclose(so3.from_quaternion(-q), matrix, atol=1e-12)


@given(vectors)
def test_roll_pitch_yaw_are_turns_about_fixed_axes(angles):
    roll, pitch, yaw = angles
    product = so3.exp([0, 0, yaw]) @ so3.exp([0, pitch, 0]) @ so3.exp([roll, 0, 0])
    np.testing.assert_allclose(so3.from_rpy(angles), product, atol=1e-12)
    np.testing.assert_allclose(so3.from_rpy(so3.to_rpy(product)), product, atol=1e-7)


@pytest.mark.parametrize('pitch', [np.pi / 2, -np.pi / 2])
def test_locked_angles_keep_the_rotation_and_put_roll_to_zero(pitch):
    matrix = so3.from_rpy([0.3, pitch, 0.5])
    angles = so3.to_rpy(matrix)
    assert angles[0] == 0.0
    np.testing.assert_allclose(so3.from_rpy(angles), matrix, atol=1e-12)


def test_almost_unit_quaternions_are_normalised():
    matrix = so3.from_quaternion([0, 0, 0, 1.0009])
    np.testing.assert_allclose(matrix, np.eye(3), atol=1e-15)


@pytest.mark.parametrize('q', [[0, 0, 0, 0], [0, 0, 0, 1.01], [0, 0, np.nan, 1]])
def test_what_is_no_unit_quaternion_is_refused(q):
    with pytest.raises(InvalidInput, match='length'):
        so3.from_quaternion(q)


def test_functions_broadcast():
    w = np.random.default_rng(1).normal(size=(2, 3, 3))
    for f in (so3.exp, so3.skew, so3.left_jacobian, so3.from_rpy):
        np.testing.assert_allclose(f(w)[1, 2], f(w[1, 2]), atol=1e-15)
    matrices = so3.exp(w)
    for f in (so3.log, so3.to_quaternion, so3.to_rpy):
        np.testing.assert_allclose(f(matrices)[1, 2], f(matrices[1, 2]), atol=1e-15)


@pytest.mark.parametrize('away', [0.0, 1e-15, 1e-13, 1e-11, 1e-8, 1e-5])
def test_angles_for_files_lead_back_to_the_rotation_however_near_pitch_is_to_a_quarter(away):
    rng = np.random.default_rng(4)
    for roll, yaw in rng.uniform(-np.pi, np.pi, (20, 2)):
        for pitch in (np.pi / 2 - away, away - np.pi / 2):
            matrix = so3.from_rpy((roll, pitch, yaw))
            back = so3.from_rpy(so3.to_rpy(matrix, so3.EXACTLY))
            assert np.abs(back - matrix).max() < 1e-13
