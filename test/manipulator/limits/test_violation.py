"""How a violation of a limit reads."""

import pytest

from manipulator.limits.limit import Violation


@pytest.mark.parametrize(
    ('value', 'low', 'high', 'words'),
    [
        (3.92, 0.5236, 3.665, '3.92 rad outside [0.5236, 3.665]'),
        (-3.1415927, -3.1415926, 3.1415926, '-3.1415927 rad outside [-3.1415926, 3.1415926]'),
        (3.66519, 0.5236, 3.66518, '3.66519 rad outside [0.5236, 3.66518]'),
        (0.1, 0.1, 1.0, '0.1 rad outside [0.1, 1]'),  # by less than a double shows
        (0.0211, 0.0234, float('inf'), '0.0211 rad below 0.0234'),
        (0.5, float('-inf'), 0.25, '0.5 rad above 0.25'),
    ],
)
def test_the_value_reads_differently_from_the_bound_that_it_is_beyond(value, low, high, words):
    violation = Violation('joint angle', 'rad', 'joint 4', value, low, high)
    assert str(violation) == f'joint 4: joint angle {words}'
