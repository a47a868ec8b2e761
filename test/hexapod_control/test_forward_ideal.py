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


def values(generators, e, s):
    result = []
    for g in generators:
        total = 0.0
        for k, coefficient in enumerate(g.coefficients):
            point = monomials.evaluate(g.degree - 2 * k, e[None])[0]
            total = total + s**k * coefficient @ point
        result.append(total / np.sqrt(sum(np.sum(c * c) for c in g.coefficients)))
    return result


@pytest.mark.parametrize('planar', [False, True])
def test_all_equations_hold_at_the_pose_and_fail_beside_it(planar):
    random = np.random.default_rng(1)
    for _ in range(10):
        equations, e, s = problem(random, planar)
        generators = equations.generators()
        assert all(np.abs(v).max() < 1e-12 for v in values(generators, e, s))
        beside = e + 0.01 * random.normal(size=4)
        assert all(np.abs(v).max() > 1e-6 for v in values(generators, beside, s))


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
