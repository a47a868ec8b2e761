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


def test_a_target_inside_is_its_own_nearest_point():
    point, weights = nearest_point(np.array([0.1, 0.2]), np.eye(2), np.ones(2))
    assert point == pytest.approx([0.1, 0.2])
    assert not weights.any()


def test_bounds_that_exclude_each_other_have_no_multipliers():
    normals = np.array([[1.0, 0.0], [-1.0, 0.0]])
    _, weights = nearest_point(np.zeros(2), normals, np.array([-1.0, -1.0]))
    assert np.isnan(weights).all()


def test_a_search_that_does_not_end_has_no_multipliers(monkeypatch):
    def endless(*_):
        raise RuntimeError('too many iterations')

    monkeypatch.setattr('scipy.optimize.nnls', endless)
    point, weights = nearest_point(np.array([0.1, 0.2]), np.eye(2), np.ones(2))
    assert point == pytest.approx([0.1, 0.2])
    assert np.isnan(weights).all()
