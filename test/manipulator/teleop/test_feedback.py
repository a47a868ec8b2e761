from types import SimpleNamespace

import numpy as np
import pytest

from manipulator.errors import InvalidInput
from manipulator.teleop.jog_modes import MAX_GAIN, Feedback
from manipulator.teleop.modes import jog_mode
from manipulator.trajectory.teleop import Teleop


def settled(gain, delay_ticks, dt=0.01, ticks=2000):
    """The largest of the last errors, of a loop that sees its error late."""
    errors = [1.0] * (delay_ticks + 1)
    for _ in range(ticks):
        errors.append(errors[-1] - dt * gain * errors[-1 - delay_ticks])
        if abs(errors[-1]) > 1e6:
            break
    return max(abs(e) for e in errors[-20:])


@pytest.mark.parametrize('delay_ticks', [1, 4, 10, 50])
def test_the_gain_for_a_delay_converges_without_overshoot(delay_ticks):
    gain = Feedback.for_delay(delay_ticks * 0.01).gain
    assert settled(gain, delay_ticks) < 1e-3


def test_a_whole_correction_a_tick_diverges_over_four_ticks():
    assert settled(gain=100.0, delay_ticks=4) > 1e6


def test_a_gain_beyond_the_boundary_of_four_ticks_diverges():
    assert settled(gain=36.0, delay_ticks=4) > 10.0
    assert settled(gain=34.0, delay_ticks=4) < 0.1


def test_without_delay_the_gain_stays_finite():
    assert Feedback.for_delay(0.0).gain == MAX_GAIN


def test_velocities_are_bounded_with_their_direction_kept():
    feedback = Feedback(5.0, linear_bound=0.1, angular_bound=0.4)
    error = np.array([0.3, -0.4, 0.0])
    assert np.allclose(feedback.linear(error), [0.06, -0.08, 0.0])
    assert np.allclose(feedback.angular(error), [0.24, -0.32, 0.0])
    assert np.allclose(feedback.linear(1e-2 * error), 5e-2 * error)


@pytest.mark.parametrize('gain', [0.0, -1.0, np.nan, np.inf])
def test_a_gain_that_is_not_positive_is_refused(gain):
    with pytest.raises(InvalidInput, match='gain'):
        Feedback(gain)


@pytest.mark.parametrize('is_measured', [False, True])
def test_modes_allow_for_the_delay_of_a_machine_that_measures_its_joints(is_measured):
    commands = []
    executor = SimpleNamespace(is_busy=False, jog=commands.append)
    teleop = Teleop(SimpleNamespace(is_measured=is_measured, executor=executor), delay=0.1)
    teleop.set_mode('hold_orientation')
    for twist in (np.zeros(6), np.eye(6)[0]):
        teleop.receive('cmd_vel', twist, '', 1.0)
    teleop.drive(1.0)
    expected = Feedback.for_delay(0.1 if is_measured else 0.0)
    assert commands[-1].mode == jog_mode('hold_orientation', expected)
