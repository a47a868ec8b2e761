import numpy as np
import pytest

from hexarm.papers.paper_arm import (
    PaperArm,
    joint_rates,
    projections,
    velocity_towards,
    wrist_factors,
)
from manipulator.errors import NoSolution

ARM = PaperArm(0.3, 0.4, 0.4)
START = np.radians([10.0, 20.0, 80.0, 20.0, 50.0, 30.0])
T = 0.01


def test_rates_move_the_wrist_centre_as_wanted_and_keep_the_orientation():
    wanted = np.array([0.1, -0.05, 0.08])
    rates = joint_rates(ARM, START, wanted)
    ahead, behind = START + 1e-6 * rates, START - 1e-6 * rates
    assert np.abs((ARM.position(ahead) - ARM.position(behind)) / 2e-6 - wanted).max() < 1e-8
    assert np.abs(projections(ahead) - projections(behind)).max() / 2e-6 < 1e-8


def test_rates_turn_the_tool_as_wanted():
    turning = np.array([0.1, 0.05, -0.2])
    rates = joint_rates(ARM, START, np.zeros(3), turning)
    ahead, behind = START + 1e-6 * rates, START - 1e-6 * rates
    assert np.abs((projections(ahead) - projections(behind)) / 2e-6 - turning).max() < 1e-8
    assert np.abs(rates[:3]).max() < 1e-12


def line(seconds=2.0):
    begin = ARM.position(START)
    return [begin + t * np.array([0.1, -0.05, 0.05]) for t in np.arange(T, seconds, T)]


def test_measured_positions_keep_the_paper_on_its_line_without_delay():
    """X' = (X_n − X_{n−1})/T: with measured X_{n−1} no step's error survives the next."""
    q, errors = START, []
    for target in line():
        q = q + T * joint_rates(ARM, q, velocity_towards(target, ARM.position(q), T))
        errors.append(np.linalg.norm(ARM.position(q) - target))
    assert max(errors) < 5e-6
    assert errors[-1] < 2 * np.median(errors)


def test_computed_positions_let_the_errors_add_up():
    q, before, measured = START, ARM.position(START), START
    for target in line():
        q = q + T * joint_rates(ARM, q, velocity_towards(target, before, T))
        drive = joint_rates(ARM, measured, velocity_towards(target, ARM.position(measured), T))
        measured = measured + T * drive
        before = target
    assert np.linalg.norm(ARM.position(q) - line()[-1]) > 20 * np.linalg.norm(
        ARM.position(measured) - line()[-1]
    )


def errors_with_delay(gain, feed_forward, ticks=4, disturbance=1e-3):
    """The wrist centre's distance from its line when measurements are `ticks` old."""
    targets = line(4.0)
    velocity = (targets[1] - targets[0]) / T
    history = [START] * (ticks + 1)
    shift = np.array([disturbance, 0.0, 0.0])
    errors = []
    for n in range(ticks, len(targets)):
        late, now = history[-1 - ticks], history[-1]
        correction = gain * (targets[n - 1 - feed_forward * ticks] - ARM.position(late) + shift)
        wanted = feed_forward * velocity + correction
        wanted *= min(1.0, 2.0 / np.linalg.norm(wanted))
        history.append(now + T * joint_rates(ARM, now, wanted))
        errors.append(np.linalg.norm(ARM.position(history[-1]) - targets[n] - shift))
    return np.array(errors)


def test_the_papers_gain_diverges_over_four_ticks_of_delay():
    errors = errors_with_delay(gain=1 / T, feed_forward=0)
    assert errors[-20:].max() > 10 * errors[:20].min()
    assert errors[-20:].max() > 0.02


def test_a_gain_that_the_delay_allows_converges():
    errors = errors_with_delay(gain=0.3 / (4 * T), feed_forward=1)
    assert errors[-20:].max() < 0.05 * errors[0]


@pytest.mark.parametrize(
    ('degrees', 'name'),
    [
        ([10, 20, 0, 20, 50, 30], 'elbow stretched or folded, sin q3'),
        ([10, -30, 60, 20, 50, 30], "wrist centre on joint 1's axis"),
        ([10, 20, 80, 20, 0, 30], 'wrist aligned, sin q5'),
    ],
)
def test_singular_postures_of_the_arm_are_named(degrees, name):
    with pytest.raises(NoSolution, match=name):
        joint_rates(ARM, np.radians(degrees), np.array([0.1, 0.0, 0.0]))


def artificially_singular(factor):
    """START with q6 (for s_z) or q1 (for a_y) turned until the factor vanishes."""
    joint = 5 if factor.endswith('s_z') else 0
    angles = np.radians(np.linspace(-90, 90, 2001))
    values = []
    for angle in angles:
        q = START.copy()
        q[joint] = angle
        values.append(wrist_factors(q)[factor])
    k = int(np.flatnonzero(np.diff(np.sign(values)))[0])
    low, high = angles[k], angles[k + 1]
    q = START.copy()
    for _ in range(60):
        q[joint] = (low + high) / 2
        same_side = np.sign(wrist_factors(q)[factor]) == np.sign(values[k])
        low, high = (q[joint], high) if same_side else (low, q[joint])
    return q


@pytest.mark.parametrize('axis', ['a_y', 's_z'])
def test_artificial_singularities_are_detected_where_the_wrist_is_regular(arm_6r, axis):
    factor = f'projections singular though the wrist is not, {axis}'
    q = artificially_singular(factor)
    with pytest.raises(NoSolution, match=factor):
        joint_rates(ARM, q, np.array([0.1, 0.0, 0.0]))
    assert arm_6r.sigma_min(arm_6r.home, q) > 0.2
    wrist = arm_6r.chain.jacobian(q)[3:, 3:]
    assert np.linalg.svd(wrist, compute_uv=False)[-1] > 0.3
