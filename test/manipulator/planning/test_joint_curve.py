"""Curves through points: by their values and derivatives at the points, as JTC defines them."""

import numpy as np
import pytest

from manipulator.planning.joint_curve import narrowest, rounded_lines, splines, widest

TIMES = np.array([0.0, 0.7, 1.5, 3.0])
RNG = np.random.default_rng(5)
Q, V, A = RNG.normal(size=(3, 4, 6))
NONE = np.full_like(A, np.nan)


@pytest.mark.parametrize('accelerations', [A, NONE])
def test_splines_pass_positions_and_velocities_and_accelerations_where_given(accelerations):
    curve = splines(TIMES, Q, V, accelerations)
    for side in (-1e-9, 1e-9):
        inside = np.clip(TIMES + side, 0.0, 3.0)
        q, rate, pull = curve.at(inside)
        assert np.abs(q - Q).max() < 1e-7
        assert np.abs(rate - V).max() < 1e-6
        if accelerations is A:
            assert np.abs(pull - A).max() < 1e-6


def test_a_cubic_is_what_is_left_where_one_of_two_points_has_no_accelerations():
    some = A.copy()
    some[1] = np.nan
    mixed, cubic, quintic = (splines(TIMES, Q, V, one) for one in (some, NONE, A))
    early, late = np.linspace(0.0, 1.49, 20), np.linspace(1.51, 3.0, 20)
    assert np.array_equal(mixed.at(early)[0], cubic.at(early)[0])
    assert np.array_equal(mixed.at(late)[0], quintic.at(late)[0])


def test_rates_and_accelerations_are_the_derivatives():
    times, h = np.linspace(0.01, 2.99, 57), 1e-6
    for curve in (splines(TIMES, Q, V, A), rounded_lines(TIMES, Q, 0.5 * widest(TIMES))):
        ahead, behind = curve.at(times + h), curve.at(times - h)
        for k in range(2):
            slope = (ahead[k] - behind[k]) / (2 * h)
            assert np.abs(slope - curve.at(times)[k + 1]).max() < 1e-3


def test_rounded_lines_are_the_lines_but_for_their_corners_and_end_at_rest():
    widths = narrowest(TIMES, Q, np.full(6, 40.0), 0.02)
    curve = rounded_lines(TIMES, Q, widths)
    assert curve.duration == pytest.approx(3.0 + widths[0] + widths[-1])
    for i in range(3):
        time = np.linspace(TIMES[i] + widths[i], TIMES[i + 1] - widths[i + 1], 9)
        share = ((time - TIMES[i]) / (TIMES[i + 1] - TIMES[i]))[:, None]
        line = (1 - share) * Q[i] + share * Q[i + 1]
        assert np.abs(curve.at(time + widths[0])[0] - line).max() < 1e-12
    ends = curve.at([0.0, curve.duration])
    assert np.abs(ends[0] - Q[[0, -1]]).max() < 1e-12
    assert np.abs(ends[1]).max() < 1e-12
    corners = curve.at(np.linspace(0.0, curve.duration, 2001))[2]
    assert np.abs(corners).max() <= 40.0 + 1e-9 or (widths == widest(TIMES)).any()
