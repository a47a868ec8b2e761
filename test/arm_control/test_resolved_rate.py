from dataclasses import replace

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from arm_control.load import jogging
from arm_control.resolved_rate import JogState
from manipulator.errors import InvalidInput
from sampling import enough

DT = 0.02
TWELVE = np.concatenate([np.eye(6), -np.eye(6)]) * np.array([0.2] * 3 + [1.0] * 3)


def drive(jog, joints, twist, ticks, dt=DT):
    """Every step's result."""
    steps, state = [], JogState.at_rest(joints)
    for _ in range(ticks):
        steps.append(jog.step(state, twist, dt))
        state = steps[-1].state
    return steps


def regular_joints(jog, count, seed):
    limits, rng = jog.arm.limits, np.random.default_rng(seed)
    joints = rng.uniform(limits.low + 0.2, limits.high - 0.2, (20 * count, 6))
    return joints[jog.arm.sigma_min(jog.arm.home, joints) > 2 * jog.onset][:count]


def test_a_slow_twist_is_driven_exactly_where_the_arm_is_regular(jog):
    rng = np.random.default_rng(1)
    for joints in regular_joints(jog, 20, 1):
        twist = rng.uniform(-1, 1, 6) * ([0.002] * 3 + [0.005] * 3)
        step = jog.step(JogState.at_rest(joints), twist, DT)
        assert step.scale == 1.0
        assert step.held_by == ''
        driven = jog.arm.chain.jacobian(joints) @ step.state.rates
        assert np.abs(driven - twist).max() < 1e-12


def test_a_fast_twist_is_scaled_as_a_whole(jog):
    for joints in regular_joints(jog, 20, 2):
        twist = np.array([2.0, -1.0, 1.5, 4.0, -3.0, 5.0])
        state = JogState.at_rest(joints)
        step = jog.step(state, twist, DT)
        assert step.scale < 1.0
        assert 'joint' in step.held_by
        driven = jog.arm.chain.jacobian(joints) @ step.state.rates
        direction = driven / np.linalg.norm(driven)
        assert np.abs(direction - twist / np.linalg.norm(twist)).max() < 1e-9
        assert driven @ twist > 0


@settings(deadline=None, max_examples=enough(8, 30))
@given(seed=st.integers(0, 2**32 - 1))
def test_no_joint_passes_its_range_speed_or_acceleration(jog, seed):
    limits, rng = jog.arm.limits, np.random.default_rng(seed)
    speed = np.minimum(limits.speed, jog.motion.joint.speed)
    acceleration = np.minimum(limits.acceleration, jog.motion.joint.acceleration)
    state = JogState.at_rest(rng.uniform(limits.low, limits.high))
    for _ in range(40):
        twist = rng.uniform(-1, 1, 6) * ([0.5] * 3 + [2.0] * 3)
        for _ in range(5):
            before, state = state, jog.step(state, twist, DT).state
            assert (state.joints >= limits.low).all()
            assert (state.joints <= limits.high).all()
            assert (np.abs(state.rates) <= speed * (1 + 1e-9)).all()
            gained = np.abs(state.rates) - np.abs(before.rates)
            assert (gained <= acceleration * DT * (1 + 1e-9)).all()


def test_rates_near_singular_postures_stay_bounded(jog):
    rng = np.random.default_rng(3)
    for offset in np.geomspace(1e-9, 1e-2, 30):
        joints = jog.arm.rest + rng.uniform(-0.3, 0.3, 6)
        joints[4] = offset
        steps = drive(jog, joints, rng.uniform(-0.2, 0.2, 6), 5)
        assert all(np.isfinite(step.state.joints).all() for step in steps)


def test_damping_begins_smoothly_at_its_onset(machine_file):
    """The rate of a twist along the weakest direction, over σmin, has no step or kink upwards."""
    jog = replace(jogging(machine_file('arm_6r')), slides=True)
    bends = np.linspace(1e-4, 0.6, 400)
    gains, margins = [], []
    for bend in bends:
        joints = jog.arm.rest.copy()
        joints[4] = bend
        jacobian = jog.arm.chain.jacobian(joints) * np.array(
            [[1 / jog.arm.characteristic_length]] * 3 + [[1]] * 3
        )
        left, sigma, _ = np.linalg.svd(jacobian)
        weakest = left[:, -1] * ([jog.arm.characteristic_length] * 3 + [1] * 3)
        step = jog.step(JogState.at_rest(joints), 1e-3 * weakest, 1.0)
        gains.append(np.linalg.norm(step.state.rates) / 1e-3)
        margins.append(sigma[-1])
    gains, margins = np.array(gains), np.array(margins)
    above = margins > jog.onset
    assert above.any()
    assert np.abs(gains * margins - 1)[above].max() < 1e-6
    assert gains.max() < 1.3 / jog.onset
    assert gains.max() > 1.29 / jog.onset
    assert gains[0] < 0.2 / jog.onset
    assert np.abs(np.diff(gains)).max() < 0.06 * gains.max()


def test_a_joint_slows_before_its_stop_and_stands_there(machine_file):
    jog = jogging(machine_file('arm_6r'))
    joints = jog.arm.rest.copy()
    joints[0] = np.radians(150)
    state, rates = JogState.at_rest(joints), []
    for _ in range(100):
        swing = 1.5 * jog.arm.chain.jacobian(state.joints)[:, 0]
        step = jog.step(state, swing, DT)
        state = step.state
        rates.append(state.rates[0])
    assert max(rates) > 1.0
    assert np.diff(rates).min() > -jog.arm.limits.acceleration[0] * DT * 1.001
    assert jog.arm.limits.high[0] - 1e-4 <= state.joints[0] <= jog.arm.limits.high[0]
    assert step.scale == 0.0
    assert step.held_by == 'stop of joint 1'


def test_a_release_stops_the_arm_along_its_direction(jog):
    joints = regular_joints(jog, 1, 4)[0]
    twist = np.array([0.1, 0.05, -0.1, 0.2, 0.1, 0.3])
    state = drive(jog, joints, twist, 30)[-1].state
    moving = state.rates / np.linalg.norm(state.rates)
    for _ in range(100):
        state = jog.step(state, np.zeros(6), DT).state
        speed = np.linalg.norm(state.rates)
        assert speed == 0 or np.abs(state.rates / speed - moving).max() < 1e-6
    assert np.abs(state.rates).max() == 0.0


@pytest.mark.parametrize('side', [1.0, -1.0])
@pytest.mark.parametrize('moving', [[3], [0, 3], [0, 1, 2, 3, 4, 5]])
def test_joints_that_all_turn_one_way_brake_no_harder_than_they_may(jog, side, moving):
    rates = np.zeros(6)
    rates[moving] = side * 0.5 * jog.arm.limits.speed[moving]
    state = replace(JogState.at_rest(jog.arm.rest), rates=rates)
    while state.rates.any():
        after = jog.step(state, np.zeros(6), DT).state
        changes = np.abs(after.rates - state.rates) / DT
        assert (changes <= 1.001 * jog.arm.limits.acceleration).all()
        state = after


def test_a_joint_beyond_its_range_moves_only_back(machine_file):
    jog = jogging(machine_file('arm_6r'))
    beyond = jog.arm.rest.copy()
    beyond[0] = jog.arm.limits.high[0] + 0.2
    moved = []
    for twist in TWELVE:
        joint = np.array([step.state.joints[0] for step in drive(jog, beyond, twist, 50)])
        assert joint.max() <= beyond[0]
        assert (np.diff(joint) <= 0).all()
        moved.append(joint[-1])
    assert min(moved) < jog.arm.limits.high[0]


def states(jog, seed, count):
    """Joint angles with many at their stops and many exactly at zero, where arms are singular."""
    limits, rng = jog.arm.limits, np.random.default_rng(seed)
    joints = rng.uniform(limits.low, limits.high, (count, 6))
    where = rng.random((count, 6))
    joints = np.where(where < 0.25, limits.low, np.where(where < 0.5, limits.high, joints))
    zeroed = (rng.random((count, 6)) < 0.3) & (limits.low <= 0) & (limits.high >= 0)
    return np.where(zeroed, 0.0, joints)


def reached(jog, joints, ticks):
    """Where each of the twelve leads to, one after the other."""
    for twist in TWELVE:
        state = before = JogState.at_rest(joints)
        for _ in range(ticks):
            before, state = state, jog.step(state, twist, DT).state
            if not state.rates.any() and not before.rates.any():
                break  # stands, and would go on standing
        yield state.joints


def reached_by_two(jog, joints, ticks):
    """Where one of the twelve leads to, then where two of them do."""
    once = []
    for there in reached(jog, joints, ticks):
        once.append(there)
        yield there
    for there in once:
        if (there != joints).any():
            yield from reached(jog, there, ticks)


def led_away(jog, seed):
    """Radians by which three deflections that each lead as far as any move one of the joints."""
    (joints,) = states(jog, seed, 1)
    here, farthest = joints, 0.0
    for _ in range(3):
        for there in reached(jog, here, 75):
            away = np.abs(there - joints).max()
            if away > 0.04:
                return away
            if away > farthest:
                here, farthest = there, away
    return farthest


@settings(deadline=None, max_examples=enough(6, 30))
@given(seed=st.integers(0, 2**32 - 1))
@example(seed=101448)  # out of this corner lead half a degree, and from there ways back
def test_some_deflection_of_the_stick_always_moves_the_arm(jog, seed):
    assert led_away(jog, seed) > 0.004


@pytest.mark.parametrize(
    'seeds',
    [
        [7833],  # wrist and elbow lost, a joint at its stop: the first deflection ends there
        [1048575],
        [1961],  # five joints at their stops: out of the corner in three deflections
        [53140],  # the first deflection ends beside the corner, where the next one slides
        range(enough(8, 100)),
    ],
)
def test_three_deflections_of_the_stick_lead_out_of_corners(jog, seeds):
    assert min(led_away(jog, seed) for seed in seeds) > 0.04


@pytest.mark.parametrize('elbow', [0.0, 1.0])
@pytest.mark.parametrize('wrist', [0.0, 1.0])
@pytest.mark.parametrize('shoulder', ['up', 'out'])
def test_two_deflections_lead_out_of_every_singular_posture(machine_file, shoulder, elbow, wrist):
    jog = jogging(machine_file('arm_6r'))
    lean = -elbow / 2 if shoulder == 'up' else 0.7
    joints = np.array([0.4, lean, elbow, 0.6, wrist, 0.2])
    is_singular = jog.arm.sigma_min(jog.arm.home, joints) < 1e-9
    assert is_singular == (shoulder == 'up' or elbow == 0.0 or wrist == 0.0)
    found = reached_by_two(jog, joints, 100)
    assert any(jog.arm.sigma_min(jog.arm.home, q) > 0.02 for q in found)


def test_sliding_out_of_a_corner_is_said_and_goes_with_the_stick(machine_file):
    jog = jogging(machine_file('arm_6r'))
    metric = np.array([jog.arm.characteristic_length**-2] * 3 + [1.0] * 3)
    slides = 0
    for joints in states(jog, 11, 40):
        for twist in TWELVE:
            step = jog.step(JogState.at_rest(joints), twist, DT)
            if step.held_by.startswith('sliding off the line') and step.state.rates.any():
                driven = jog.arm.chain.jacobian(joints) @ step.state.rates
                assert driven @ (metric * twist) > 0
                slides += 1
    assert slides > 10


CORNERS = [
    ('arm_6r', [-2.96706, -1.210189, -2.617994, -3.141593, 0.109612, 6.108652]),
    ('ur5', [-0.032387, -6.283185, 3.591289, -1.072466, 2.946607, -6.283185]),
    ('puma560', [-2.792527, 3.057604, -2.904086, 2.96706, 0.001, -4.642576]),
]


@pytest.mark.parametrize(('name', 'joints'), CORNERS)
def test_who_slides_out_of_a_corner_has_no_other_way_to_drive(machine_file, name, joints):
    """Near a singular posture with joints at their stops; no twist may slide if one is driven."""
    jog = jogging(machine_file(name))
    joints = np.clip(joints, jog.arm.limits.low, jog.arm.limits.high)
    steps = [jog.step(JogState.at_rest(joints), twist, DT) for twist in TWELVE]
    is_sliding = any('corner of the joint ranges' in step.held_by for step in steps)
    is_driven = any(s.scale > 0.0 and not s.held_by.startswith('sliding') for s in steps)
    assert is_sliding != is_driven


def test_commands_that_are_not_six_finite_numbers_are_refused(machine_file):
    jog = jogging(machine_file('arm_6r'))
    state = JogState.at_rest(jog.arm.rest)
    for twist in (np.zeros(5), np.array([0, 0, np.nan, 0, 0, 0])):
        with pytest.raises(InvalidInput, match='needs six finite'):
            jog.step(state, twist, DT)
    with pytest.raises(InvalidInput, match='positive'):
        jog.step(state, np.zeros(6), 0.0)
    with pytest.raises(InvalidInput, match='six finite angles'):
        JogState.at_rest(np.full(6, np.inf))
