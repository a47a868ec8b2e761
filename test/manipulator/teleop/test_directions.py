import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from manipulator import rotation as so3
from manipulator.teleop.jog_modes import turn_between, turn_but_about


def unit(rng):
    vector = rng.normal(size=3)
    return vector / np.linalg.norm(vector)


@settings(deadline=None, max_examples=100)
@given(st.integers(0, 2**32 - 1))
def test_turning_by_the_turn_brings_one_direction_to_the_other(seed):
    rng = np.random.default_rng(seed)
    a, b = unit(rng), unit(rng)
    turn = turn_between(a, b)
    assert np.abs(so3.exp(turn) @ a - b).max() < 1e-9
    assert np.linalg.norm(turn) == pytest.approx(np.arccos(np.clip(a @ b, -1, 1)), abs=1e-6)


@pytest.mark.parametrize('axis', range(3))
def test_opposite_directions_take_half_a_turn(axis):
    a = np.eye(3)[axis]
    turn = turn_between(a, -a)
    assert np.linalg.norm(turn) == pytest.approx(np.pi)
    assert np.abs(so3.exp(turn) @ a + a).max() < 1e-12
    assert not turn_between(a, a).any()


@settings(deadline=None, max_examples=100)
@given(st.integers(0, 2**32 - 1))
def test_turns_about_the_axis_do_not_count(seed):
    rng = np.random.default_rng(seed)
    axis, rotation = unit(rng), so3.exp(rng.uniform(0, 2) * unit(rng))
    rest = turn_but_about(axis, rotation)
    assert abs(rest @ axis) < 1e-9
    turned = so3.exp(rng.uniform(-3, 3) * axis) @ rotation
    assert np.abs(turn_but_about(axis, so3.exp(0.7 * axis))).max() < 1e-9
    assert np.linalg.norm(turn_but_about(axis, turned)) == pytest.approx(
        np.linalg.norm(rest), abs=1e-7
    )
    others = [
        np.linalg.norm(so3.log(so3.exp(angle * axis) @ rotation))
        for angle in np.linspace(-np.pi, np.pi, 361)
    ]
    assert np.linalg.norm(rest) <= min(others) + 1e-9
