"""The edges of what the trigonometric subproblems solve, and what is said beyond them."""

import numpy as np
import pytest

from arm_control.chain import Chain
from arm_control.closed_forms import SphericalWrist, closed_form
from manipulator.pose import Pose

X, _, Z = np.eye(3)
UPPER, FORE, AHEAD = 0.4, 0.3, 0.1


def jointed_arm(size=1.0, ahead=0.0):
    """Joint 1 about z, shoulder `ahead` of it, upper arm and forearm up; the tool at the wrist."""
    heights = np.array([0.0, 0.0, UPPER, UPPER + FORE, UPPER + FORE, UPPER + FORE])
    points = size * (np.outer(heights, Z) + ahead * np.outer([0, 1, 1, 1, 1, 1], [0, 1, 0]))
    chain = Chain(np.array([Z, -X, -X, Z, -X, Z]), points, Pose(points[5], np.eye(3)))
    form = closed_form(chain)
    assert isinstance(form, SphericalWrist)
    return form


def branches(form, *place):
    return form.branches(Pose(np.array(place), np.eye(3)), np.zeros(6))


@pytest.mark.parametrize('size', [1e-2, 1.0, 1e3])
@pytest.mark.parametrize(('beyond', 'is_solved'), [(1e-10, True), (1e-7, False)])
def test_what_overshoots_by_rounding_is_solved_whatever_the_unit_of_length(
    size, beyond, is_solved
):
    reach = (1.0 + beyond) * (UPPER + FORE) * size
    assert np.isfinite(branches(jointed_arm(size), 0.0, 0.6 * reach, 0.8 * reach)).all() == (
        is_solved
    )


@pytest.mark.parametrize(('distance', 'is_solved'), [(0.5, True), (0.7, True), (0.71, False)])
def test_two_links_reach_as_far_as_both_are_long(distance, is_solved):
    assert np.isfinite(branches(jointed_arm(), 0.0, distance, 0.0)).any() == is_solved


def test_of_two_places_too_near_to_the_shoulder_the_farther_is_named():
    """From in front of the shoulder and from behind; nearer than 0.1 m the elbow cannot bend."""
    form, (out, up) = jointed_arm(ahead=AHEAD), (0.01, 0.03)
    front, behind = (np.hypot(side * out - AHEAD, up) for side in (1, -1))
    assert front < UPPER - FORE < behind
    assert np.isfinite(branches(form, 0.0, out, up)).any()
    form, (out, up) = jointed_arm(ahead=AHEAD / 4), (0.01, 0.03)
    front, behind = (np.hypot(side * out - AHEAD / 4, up) for side in (1, -1))
    assert front < behind < UPPER - FORE
    assert form.refusal(Pose(np.array([0.0, out, up]), np.eye(3))) == (
        f'wrist centre {behind:.4g} m from the shoulder, needs at least 0.1 m'
    )


def test_of_two_places_too_far_from_the_shoulder_the_nearer_is_named():
    form, out = jointed_arm(ahead=AHEAD), 1.5
    assert form.refusal(Pose(np.array([0.0, out, 0.0]), np.eye(3))) == (
        f'wrist centre {out - AHEAD:.4g} m from the shoulder, reach is 0.7 m'
    )
