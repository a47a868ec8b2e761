import numpy as np
import pytest

from manipulator.analysis.slope import nearest_point


def test_nearest_point_keeps_every_bound_and_pulls_only_against_what_it_touches():
    generator = np.random.default_rng(1)
    for _ in range(200):
        normals, target = generator.standard_normal((12, 6)), generator.standard_normal(6) * 3
        slack = generator.uniform(0.0, 1.0, 12)
        point, weights = nearest_point(target, normals, slack)
        room = normals @ point + slack
        assert room.min() > -1e-9
        assert weights.min() >= 0.0
        assert np.abs(weights * room).max() < 1e-8
        np.testing.assert_allclose(point - target, weights @ normals, atol=1e-8)


def test_as_many_bounds_as_fit_are_met_in_a_corner():
    """Also where a bound is there twice, or follows from others."""
    normals = np.vstack([np.eye(6), np.eye(6), np.full((1, 6), 6**-0.5)])
    point, weights = nearest_point(np.full(6, -1.0), normals, np.zeros(13))
    np.testing.assert_allclose(point, 0.0, atol=1e-12)
    np.testing.assert_allclose(weights @ normals, 1.0, atol=1e-9)


def test_a_target_inside_is_its_own_nearest_point():
    target = np.arange(6) / 10
    point, weights = nearest_point(target, np.eye(6), np.ones(6))
    np.testing.assert_array_equal(point, target)
    assert not weights.any()
    assert nearest_point(target, np.empty((0, 6)), np.empty(0))[0] == pytest.approx(target)


def test_bounds_that_exclude_each_other_have_no_multipliers():
    normals = np.vstack([np.eye(6)[:1], -np.eye(6)[:1]])
    point, weights = nearest_point(np.full(6, 0.3), normals, np.array([-1.0, -1.0]))
    assert point == pytest.approx(np.full(6, 0.3))
    assert np.isnan(weights).all()


def test_what_is_found_keeps_every_bound_also_where_hardly_anything_does():
    """Bounds that are there twice, or against each other: a point that keeps all, or none."""
    random, found = np.random.default_rng(4), 0
    for _ in range(1000):
        normals = random.standard_normal((random.integers(5, 60), 6))
        normals[1], normals[2], normals[3] = normals[0], normals[0] * (1 + 1e-9), -normals[0]
        normals /= np.linalg.norm(normals, axis=1, keepdims=True)
        slack = random.standard_normal(len(normals)) * random.choice([1e-6, 1.0])
        target = random.standard_normal(6) * random.choice([0.0, 1e-3, 10.0])
        point, weights = nearest_point(target, normals, slack)
        if np.isfinite(weights).all():
            found += 1
            assert (normals @ point + slack).min() > -1e-7
    assert 50 < found < 950
