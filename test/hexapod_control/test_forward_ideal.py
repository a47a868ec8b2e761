import numpy as np
import pytest

from hexapod_control import forward_ideal as monomials
from hexapod_control.forward_ideal import LegEquations, turned
from manipulator import rotation as so3


def problem(random, planar):
    base, platform = random.normal(size=(6, 3)), random.normal(size=(6, 3))
    if planar:
        base[:, 2] = platform[:, 2] = 0.0
    e = random.normal(size=4)
    e /= np.linalg.norm(e)
    rotation = so3.from_quaternion([*e[1:], e[0]])
    position = random.normal(size=3)
    lengths = np.linalg.norm(platform @ rotation.T + position - base, axis=1)
    equations = LegEquations.of(base, platform, lengths)
    joint = (position + rotation @ platform[0] - base[0]) / equations.scale
    s = np.concatenate([joint, rotation.T @ joint]) @ equations.kappa1
    return equations, 1.7 * e, 1.7**2 * s


def values(coefficients, e, s):
    """Of the cubics, the quartics and the sextics at e and s."""
    result, start = [], 0
    for degree, powers, count in monomials.GENERATORS:
        point = np.concatenate(
            [s**k * monomials.evaluate(degree - 2 * k, e[None])[0] for k in range(powers)]
        )
        size = count * len(point)
        result.append(coefficients[start : start + size].reshape(count, -1) @ point)
        start += size
    return result


@pytest.mark.parametrize('planar', [False, True])
def test_all_equations_hold_at_the_pose_and_fail_beside_it(planar):
    random = np.random.default_rng(1)
    for _ in range(10):
        equations, e, s = problem(random, planar)
        coefficients = equations.coefficients()
        assert all(np.abs(v).max() < 1e-12 for v in values(coefficients, e, s))
        beside = e + 0.01 * random.normal(size=4)
        assert all(np.abs(v).max() > 1e-6 for v in values(coefficients, beside, s))


def test_turned_is_the_rotation_times_the_squared_length():
    e = np.random.default_rng(2).normal(size=(5, 4))
    square = np.sum(e * e, axis=1)
    expected = so3.from_quaternion((e / np.sqrt(square)[:, None])[:, [1, 2, 3, 0]])
    assert np.allclose(turned(e), square[:, None, None] * expected)


def test_shifting_an_evaluation_multiplies_it():
    degree, e, s = 6, np.array([0.3, -0.7, 1.1, 0.4]), 0.6

    def evaluation(n):
        powers = range(monomials.S_POWERS)
        plain = [s**k * monomials.evaluate(n - 2 * k, e[None])[0] for k in powers]
        return monomials.row_scales(n) * np.concatenate(plain)

    index, factor = monomials.shift_table(degree)
    for j in range(4):
        shifted = factor[j] * evaluation(degree)[index[j]]
        assert np.allclose(shifted, e[j] * evaluation(degree - 1))


def test_scaled_monomials_have_the_length_of_their_point():
    e = np.array([[0.3, -0.7, 1.1, 0.4]])
    for degree in range(9):
        length = np.linalg.norm(monomials.scales(degree) * monomials.evaluate(degree, e))
        assert length == pytest.approx(np.linalg.norm(e) ** degree)


def test_the_mixed_multiples_vanish_at_a_solution():
    random = np.random.default_rng(5)
    for _ in range(5):
        equations, e, s = problem(random, planar=False)
        table = monomials.multiples(8, monomials.GENERATORS)
        assert (table.rows, table.columns) == (774, 284)
        mixed = table.mixed(equations.coefficients(), 252)
        plain = [s**k * monomials.evaluate(8 - 2 * k, e[None])[0] for k in range(3)]
        point = monomials.row_scales(8) * np.concatenate(plain)
        assert np.abs(mixed.T @ point).max() < 1e-11
        assert np.linalg.matrix_rank(mixed, tol=1e-9) == 244
