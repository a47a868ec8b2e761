import numpy as np
import pytest

from manipulator.planning.path_limits import Rows, fastest


def straight(length, intervals, acceleration):
    """One axis that moves as the parameter does: |s̈| ≤ acceleration."""
    pull = np.full((intervals, 1), intervals / (2 * length))
    on_begin = np.concatenate([-pull, pull], axis=1)
    return Rows(on_begin, -on_begin, np.full((intervals, 2), acceleration))


def test_straight_path_is_driven_with_full_acceleration_and_full_braking():
    length, intervals, acceleration = 2.0, 400, 3.0
    squares = fastest(straight(length, intervals, acceleration), np.full(intervals + 1, np.inf))
    s = np.linspace(0.0, length, intervals + 1)
    np.testing.assert_allclose(squares, 2 * acceleration * np.minimum(s, length - s), atol=1e-9)


def test_speed_limit_cuts_the_top_off():
    squares = fastest(straight(2.0, 400, 3.0), np.full(401, 1.5))
    assert squares.max() == 1.5
    assert (squares == 1.5).sum() == pytest.approx(401 * (1 - 2 * 0.25 / 2), abs=3)


def test_dip_of_the_limit_is_approached_and_left_within_the_acceleration():
    highest = np.full(401, 4.0)
    highest[200] = 0.01
    squares = fastest(straight(2.0, 400, 3.0), highest)
    pull = np.abs(np.diff(squares)) / (2 * 2.0 / 400)
    assert pull.max() == pytest.approx(3.0)
    assert squares[200] == 0.01


def test_random_limits_are_kept_and_never_deadlock():
    rng = np.random.default_rng(0)
    for _ in range(20):
        rates = np.cumsum(rng.normal(0, 0.2, (301, 6)), axis=0)
        step = 0.01
        bend, pull = np.diff(rates, axis=0) / step, rates / (2 * step)
        begin = np.concatenate([bend - pull[:-1], pull[:-1] - bend], axis=1)
        end = np.concatenate([pull[:-1], -pull[:-1]], axis=1)
        rows = Rows(begin, end, np.ones((300, 12)))
        squares = fastest(rows, np.full(301, 5.0))
        spent = begin * squares[:-1, None] + end * squares[1:, None]
        assert spent.max() <= 1.0 + 1e-9
        assert squares[1:-1].min() > 0.0


@pytest.mark.parametrize('unit', [1e-3, 1e3])
def test_the_unit_of_a_row_does_not_matter(unit):
    rows, highest = straight(2.0, 400, 3.0), np.full(401, np.inf)
    scaled = Rows(unit * rows.on_begin, unit * rows.on_end, unit * rows.bound)
    np.testing.assert_allclose(fastest(scaled, highest), fastest(rows, highest), rtol=1e-9)
