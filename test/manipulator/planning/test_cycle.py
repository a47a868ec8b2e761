import numpy as np
import pytest

from manipulator.errors import InvalidInput
from manipulator.planning.cycle import Cycle
from manipulator.pose import Pose

CENTRE = Pose.from_xyz_rpy((0.01, 0.02, 0.3), (0.1, -0.2, 0.3))


def cycle(**changes):
    terms = {
        'amplitude': [0.01, 0.02, 0.005, 0.1, 0.2, 0.3],
        'frequency': [0.5, 0.25, 1.0, 0.5, 0.75, 1.25],
        'phase': [0.0, 1.0, 2.0, 3.0, 4.0, 5.0],
    }
    return Cycle(CENTRE, **(terms | changes))


def test_pose_repeats_after_the_common_period_and_not_before():
    motion = cycle()
    assert motion.checked_duration == 4.0
    t = 0.37
    assert np.abs(motion.at(t).pose.twist_to(motion.at(t + 4.0).pose)).max() < 1e-12
    assert np.abs(motion.at(t).pose.twist_to(motion.at(t + 2.0).pose)).max() > 1e-3


def test_twist_and_acceleration_are_the_derivatives_of_the_pose():
    motion, h = cycle(), 1e-5
    for t in np.linspace(0, 4, 23):
        before, now, after = (motion.at(t + k * h) for k in (-1, 0, 1))
        np.testing.assert_allclose(
            now.twist, before.pose.twist_to(after.pose) / (2 * h), atol=1e-6
        )
        np.testing.assert_allclose(
            now.acceleration, (after.twist - before.twist) / (2 * h), atol=1e-4
        )


def test_terms_of_one_axis_add_up():
    one = cycle(amplitude=[0.01, 0, 0, 0, 0, 0], frequency=[0.5] * 6, phase=[0.3] * 6)
    two = cycle(amplitude=[0.02, 0, 0, 0, 0, 0], frequency=[1.5] * 6, phase=[0.7] * 6)
    both = Cycle(
        CENTRE,
        np.vstack([one.amplitude, two.amplitude]),
        np.vstack([one.frequency, two.frequency]),
        np.vstack([one.phase, two.phase]),
    )
    t = np.linspace(0, 2, 9)
    sum_of_both = one.at(t).pose.position + two.at(t).pose.position - CENTRE.position
    np.testing.assert_allclose(both.at(t).pose.position, sum_of_both, atol=1e-15)


def test_frequencies_without_a_common_period_are_refused():
    with pytest.raises(InvalidInput, match='common period'):
        cycle(frequency=[0.501, 0.257, 1.003, 0.5, 0.5, 0.5])


@pytest.mark.parametrize(
    'changes',
    [
        {'amplitude': [0.1] * 5},
        {'frequency': [-1.0] * 6},
        {'phase': [float('nan')] * 6},
        {'amplitude': [[0.1] * 6] * 2},
    ],
)
def test_terms_that_do_not_fit_are_refused(changes):
    with pytest.raises(InvalidInput, match='cycle'):
        cycle(**changes)
