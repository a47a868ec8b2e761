"""Fits whose answer is known, and those that there are not."""

import numpy as np
import pytest

from manipulator.analysis.identify import fit
from manipulator.errors import NoSolution

FREE = np.full(2, np.inf)


def valley(x):
    """Rosenbrock's function, whose minimum lies at (1, 1)."""
    slopes = np.array([[-20.0 * x[0], 10.0], [-1.0, 0.0]])
    return np.array([10.0 * (x[1] - x[0] ** 2), 1.0 - x[0]]), slopes


def test_the_end_of_a_curved_valley_is_found():
    np.testing.assert_allclose(fit(valley, FREE).values, [1.0, 1.0], atol=1e-7)


def test_where_a_machine_cannot_stand_a_shorter_step_is_tried():
    tried = []

    def errors(x):
        tried.append(float(x[1]))
        if x[1] < -0.5:
            raise NoSolution('no pose')
        return valley(x)

    start_is_far = np.array([-1.2, 1.0])
    found = fit(lambda x: errors(x + start_is_far), FREE)
    np.testing.assert_allclose(found.values + start_is_far, [1.0, 1.0], atol=1e-7)
    assert min(tried) < -0.5


def test_a_prior_and_a_measurement_meet_by_their_weights():
    """One error of noise 1 at slope 1, a tolerance of 2: the mean of 0 and 5 by 1/4 and 1."""
    found = fit(lambda x: (x - 5.0, np.eye(1)), np.array([2.0]))
    assert found.values == pytest.approx([4.0])
    assert found.covariance == pytest.approx(np.array([[0.8]]))


def test_a_value_that_nothing_sees_stays():
    slopes = np.array([[1.0, 0.0], [2.0, 0.0], [0.0, 0.0]])
    found = fit(lambda x: (slopes @ x - np.array([1.0, 2.0, 0.0]), slopes), FREE)
    np.testing.assert_allclose(found.values, [1.0, 0.0], atol=1e-9)


def test_errors_without_a_minimum_are_no_machine():
    with pytest.raises(NoSolution, match='do not converge'):
        fit(lambda x: (np.exp(-x), -np.diag(np.exp(-x))), FREE)


def test_no_machine_at_the_beginning_is_reported():
    def errors(_):
        raise NoSolution('no pose')

    with pytest.raises(NoSolution, match='no pose'):
        fit(errors, FREE)
