import contextlib
import math

import numpy as np
import pytest

from bridge.calibration import Calibration
from bridge.command_validator import CommandValidator
from bridge.servo_config import BoardConfig
from hexarm import machines
from manipulator.errors import InvalidInput, ManipulatorError, Refused

CALIBRATION = Calibration.from_config(BoardConfig.from_machine(machines.read('robocake')).servos)
NAMES = list(CALIBRATION.names)
PARK = CALIBRATION.park
NOW = 1000.0


@pytest.fixture
def validator():
    return CommandValidator(CALIBRATION, deadline=0.2)


def admit(validator, positions=PARK, names=NAMES, stamp=None, receipt=NOW, present=PARK):
    return validator.admit(names, positions, stamp, receipt, present)


def test_a_good_command_becomes_a_setpoint_with_the_deadline(validator):
    setpoint = admit(validator)
    assert setpoint.deadline_ms == 200
    assert setpoint.counts == (3000,) * 6


def test_joints_may_come_in_any_order(validator):
    wanted = PARK + np.radians([0.5, 1, 1.5, 2, 2.5, 2.9])
    order = [3, 0, 5, 1, 4, 2]
    shuffled = admit(validator, wanted[order], [NAMES[i] for i in order])
    assert shuffled == admit(validator, wanted)
    assert len(set(shuffled.counts)) == 6


@pytest.mark.parametrize(
    ('names', 'problem'),
    [
        ([*NAMES[:5], 'crank_7'], "unknown joint 'crank_7'"),
        ([*NAMES[:5], 'crank_1'], 'joint crank_1 is named twice'),
        ([*NAMES[:4], 'crank_4', 'crank_6'], 'joint crank_4 is named twice'),
        (NAMES[:4], 'no position for crank_5, crank_6'),
        ([], 'no position for crank_1'),
        ([f'j{i}' for i in range(10_000)], "unknown joint 'j0'"),
        (['x' * 100_000], "unknown joint 'x{80}'"),
    ],
)
def test_wrong_names_are_named(validator, names, problem):
    with pytest.raises(InvalidInput, match=problem) as caught:
        admit(validator, np.full(len(names), 2.0), names)
    assert len(str(caught.value)) < 300


def test_names_without_positions_are_refused(validator):
    with pytest.raises(InvalidInput, match='6 joint names, but 5 positions'):
        admit(validator, PARK[:5])


@pytest.mark.parametrize('bad', [math.nan, math.inf, 3.9])
def test_a_bad_value_refuses_the_whole_and_the_next_good_command_works(validator, bad):
    wanted = PARK.copy()
    wanted[3] = bad
    with pytest.raises(InvalidInput, match='crank_4'):
        admit(validator, wanted)
    assert admit(validator).counts == (3000,) * 6


def test_reordered_and_old_commands_are_refused(validator):
    admit(validator, stamp=50.0, receipt=NOW)
    with pytest.raises(InvalidInput, match='reordered'):
        admit(validator, stamp=49.9, receipt=NOW + 0.01)
    with pytest.raises(InvalidInput, match='old'):
        admit(validator, stamp=50.1, receipt=NOW + 0.4)
    admit(validator, stamp=52.1, receipt=NOW + 2.1)


def test_a_sender_whose_clock_is_off_by_an_hour_is_received_and_reported(validator):
    for k in range(10):
        admit(validator, stamp=NOW - 3600 + 0.01 * k, receipt=NOW + 0.01 * k)
    assert validator.clock_offset == pytest.approx(3600)
    assert validator.has_notable_offset


def is_admitted(validator, stamp, receipt):
    try:
        admit(validator, stamp=stamp, receipt=receipt)
    except ManipulatorError:
        return False
    return True


def test_a_sender_whose_clock_goes_as_ours_is_not_reported(validator):
    assert not validator.has_notable_offset
    admit(validator, stamp=NOW - 0.01, receipt=NOW)
    assert validator.clock_offset == pytest.approx(0.01)
    assert not validator.has_notable_offset


@pytest.mark.parametrize('step', [3600.0, -3600.0])
def test_a_clock_that_is_set_makes_no_gap_as_long_as_the_deadline(validator, step):
    times = NOW + 0.01 * np.arange(200)
    stamps = np.where(times < NOW + 1.0, times, times + step)
    pairs = zip(stamps.tolist(), times.tolist(), strict=True)
    received = [receipt for stamp, receipt in pairs if is_admitted(validator, stamp, receipt)]
    assert max(np.diff(received)) <= 0.1


@pytest.mark.parametrize(('step', 'old'), [(3600.0, -1.0), (3600.0, 3599.0), (-3600.0, -3601.0)])
def test_old_commands_do_not_pass_because_the_clock_was_set(validator, step, old):
    for k in range(200):
        receipt = NOW + 0.01 * k
        is_admitted(validator, receipt if k < 100 else receipt + step, receipt)
        if k > 120:
            assert not is_admitted(validator, receipt + old, receipt + 0.002)


def test_the_first_command_must_start_where_the_joints_are(validator):
    wanted = PARK.copy()
    wanted[1] += math.radians(4)
    with pytest.raises(Refused, match=r'crank_2: .* would jump by .* from the reported position'):
        admit(validator, wanted)
    wanted[1] -= math.radians(2)
    assert admit(validator, wanted).counts[1] != 3000


def test_a_stream_at_the_servos_speed_passes_and_a_faster_one_does_not(validator):
    speed, angle = CALIBRATION.speed, 0.0
    for k in range(10):
        angle = 0.95 * speed * 0.01 * k
        admit(validator, PARK + angle * np.array([1, 0, 0, 0, 0, 0]), receipt=NOW + 0.01 * k)
    leap = PARK + (angle + speed * 0.035) * np.array([1, 0, 0, 0, 0, 0])
    with pytest.raises(Refused, match=r'crank_1: .* from the last command'):
        admit(validator, leap, receipt=NOW + 0.1)


@pytest.mark.parametrize(('part', 'is_refused'), [(0.99, False), (1.01, True)])
def test_what_a_late_command_left_of_a_gap_the_next_may_use_and_no_more(
    validator, part, is_refused
):
    step = 0.01 * CALIBRATION.speed  # 10 ms of the way that the servos could have gone in 40
    admit(validator, PARK)
    admit(validator, PARK + step, receipt=NOW + 0.04)
    left = 0.04 - 0.02 - 0.01
    leap = PARK + step + part * (0.02 + left) * CALIBRATION.speed
    with pytest.raises(Refused, match='would jump') if is_refused else contextlib.nullcontext():
        admit(validator, leap, receipt=NOW + 0.04)


@pytest.mark.parametrize('tick', [0.01, 0.02])
@pytest.mark.parametrize(('part', 'is_refused'), [(0.99, False), (1.01, True)])
def test_regular_commands_save_nothing_up_for_a_longer_step(validator, tick, part, is_refused):
    for k in range(10):
        admit(validator, PARK, receipt=NOW + tick * k)
    leap = PARK + part * (0.02 + tick) * CALIBRATION.speed
    with pytest.raises(Refused, match='would jump') if is_refused else contextlib.nullcontext():
        admit(validator, leap, receipt=NOW + tick * 10)


def test_after_a_silence_the_joints_count_and_not_the_last_command(validator):
    admit(validator, PARK)
    moved = PARK + 0.15
    with pytest.raises(Refused, match='the reported position'):
        admit(validator, PARK, receipt=NOW + 0.3, present=PARK + 0.3)
    admit(validator, moved, receipt=NOW + 0.3, present=moved)


def test_repeating_a_leap_does_not_make_it_pass(validator):
    admit(validator, PARK)
    refused = 0
    for k in range(1, 100):
        try:
            admit(validator, PARK + 1.0, receipt=NOW + 0.01 * k)
        except Refused:
            refused += 1
    assert refused == 99


def test_without_known_joints_nothing_passes(validator):
    for present in (None, np.full(6, np.nan), np.append(PARK[:5], np.nan)):
        with pytest.raises(Refused, match='not known at present'):
            admit(validator, present=present)


def test_after_restart_the_joints_count_again(validator):
    admit(validator, PARK)
    validator.restart()
    with pytest.raises(Refused, match='the reported position'):
        admit(validator, PARK, present=PARK + 0.5)


def test_what_was_sent_before_the_machine_was_known_to_hold_moves_nothing(validator):
    admit(validator, stamp=NOW)
    for stamp, receipt in ((NOW + 0.35, NOW + 0.5), (NOW + 0.39, NOW + 0.501)):
        with pytest.raises(Refused, match='before the machine was known to hold'):
            validator.admit(NAMES, PARK, stamp, receipt, PARK, holding_since=NOW + 0.4)
    validator.admit(NAMES, PARK, NOW + 0.41, NOW + 0.502, PARK, holding_since=NOW + 0.4)


def test_every_refusal_is_one_of_ours(validator):
    with pytest.raises(ManipulatorError):
        admit(validator, ['a'] * 0, ['b'])
