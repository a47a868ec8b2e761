"""The edges of what the trigonometric subproblems solve, and what is said beyond them."""

import numpy as np
import pytest

from arm_control.subproblems import TwoLink, distance_angles, projection_angles

X, _, Z = np.eye(3)


@pytest.mark.parametrize('size', [1e-3, 1.0, 1e3])
@pytest.mark.parametrize(('beyond', 'is_solved'), [(1e-10, True), (1e-8, False)])
def test_what_overshoots_by_rounding_is_solved_whatever_the_unit_of_length(
    size, beyond, is_solved
):
    reach = (1.0 + beyond) * size
    found = projection_angles(Z, X, size * X, np.array(reach), np.zeros(()))
    assert np.isfinite(found).all() == is_solved
    found = projection_angles(Z, size * X, X, np.array(reach), np.zeros(()))
    assert np.isfinite(found).all() == is_solved


@pytest.mark.parametrize(('distance', 'is_solved'), [(0.5, True), (0.7, True), (0.71, False)])
def test_two_links_reach_as_far_as_both_are_long(distance, is_solved):
    found = distance_angles(Z, 0.4 * X, -0.3 * X, np.array(distance), np.zeros(()))
    assert np.isfinite(found).all() == is_solved


def test_of_two_places_too_near_to_the_shoulder_the_farther_is_named(arm_6r):
    """Upper arm and forearm made unlike each other: nearer than their difference is no elbow."""
    chain = arm_6r.chain
    shoulder, elbow = chain.points[1:3]
    arm = TwoLink(chain, elbow + 0.4 * (elbow - shoulder))
    core = 0.6 * np.linalg.norm(elbow - shoulder)
    ahead = (elbow - shoulder) / np.linalg.norm(elbow - shoulder)
    places = shoulder + np.outer([0.02, 0.05, 0.03], ahead)
    assert arm.elbow_refusal('tip', places) == (
        f'tip 0.05 m from the shoulder, needs at least {core:.4g} m'
    )
