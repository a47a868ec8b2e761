"""The walk through the servos, key by key, without a board."""

import random

import pytest

from bridge.servo_config import BoardConfig
from bridge.servo_wizard import SPEED_US_S, STEPS_US, ServoWizard, Stage
from hexarm import machines

SERVOS = BoardConfig.from_machine(machines.read('robocake')).servos.joints
LINEAR = BoardConfig.from_machine(machines.read('stewart_6_6')).servos.joints
CENTRES = (1500.0,) * 6
KEYS = ['right', 'left', '+', '-', 'y', 'n', 'enter', 's', 'b', 'q', 'w', '=', '9', '.', '[', ']']


def begin(servos=SERVOS, chosen=(0, 1)):
    return ServoWizard.begin(servos, CENTRES, chosen)


def settle(wizard):
    for _ in range(2000):
        if wizard.pulse == wizard.target:
            return wizard
        wizard = wizard.advance(0.02)
    raise AssertionError('never arrives')


def press(wizard, *keys):
    for key in keys:
        wizard = settle(wizard.press(key))
    return wizard


def test_a_press_moves_one_servo_by_one_step_and_slowly():
    wizard = begin().press('right')
    assert wizard.target == 1520.0
    wizard = wizard.advance(0.02)
    assert wizard.pulses == (1500.0 + 0.02 * SPEED_US_S, *CENTRES[1:])
    assert settle(wizard).pulses == (1520.0, *CENTRES[1:])


def test_a_key_that_is_held_never_runs_ahead_by_more_than_a_step():
    wizard = begin()
    for _ in range(30):
        wizard = wizard.press('right')
    assert wizard.target == 1520.0


@pytest.mark.parametrize('seed', range(20))
def test_no_keys_lead_beyond_the_pulse_range_or_move_two_servos_at_once(seed):
    luck = random.Random(seed)
    wizard = begin(chosen=(0, 1, 2, 3, 4, 5))
    for _ in range(1500):
        before = wizard
        wizard = wizard.press(luck.choice([*KEYS, *['right'] * 20 * (seed % 2)]))
        if wizard.is_over:
            break
        wizard = wizard.advance(luck.choice([0.02, 0.1]))
        moved = [i for i in range(6) if wizard.pulses[i] != before.pulses[i]]
        assert len(moved) <= 1
        assert all(550.0 <= pulse <= 2450.0 for pulse in wizard.pulses)
        steps = [abs(a - b) for a, b in zip(wizard.pulses, before.pulses, strict=True)]
        assert max(steps) <= 0.1 * SPEED_US_S + 1e-9


def test_sign_centre_scale_and_range_of_one_servo():
    wizard = press(begin(chosen=(0,)), 'right', 'n')
    assert wizard.stage is Stage.CENTRE
    wizard = press(wizard, '-', 'left', 'left', 'enter')
    assert wizard.stage is Stage.SCALE
    wizard = press(wizard, '+', '+', *['right'] * 4, '=', '1', '0', '0', 'enter')
    assert wizard.stage is Stage.RANGE
    wizard = press(wizard, *['right'] * 3, ']', 'enter')
    servo = wizard.advance(0.02).servos[0]
    assert (servo.sign, servo.centre_us, servo.centre_deg) == (-1, 1510.0, 120.0)
    assert servo.us_per_deg == pytest.approx(200 / 20)
    assert servo.pulse_range_us == (550.0, 1860.0)


def test_the_servo_returns_to_its_new_centre_before_the_next_one_is_asked_for():
    wizard = press(begin(), 's', 'right', 'enter', 'right', 's').press('s')
    assert (wizard.at, wizard.stage) == (0, Stage.RETURN)
    assert wizard.target == 1520.0
    wizard = settle(wizard.advance(0.02))
    assert (wizard.at, wizard.stage) == (1, Stage.DIRECTION)
    assert wizard.pulses == (1520.0, *CENTRES[1:])
    assert wizard.target == wizard.pulse == 1500.0


@pytest.mark.parametrize(
    ('keys', 'text'),
    [
        (['y'], 'jog it by 20 µs first'),
        (['enter'], 'has no function here'),
        (['s', '=', '.', 'enter'], 'is not a number'),
        (['s', 'enter', '=', '9', '0', 'enter'], 'too near the centre'),
        (['s', 'enter', '+', 'right', 'right', 'right', '=', '9', '0', 'enter'], 'contradicts'),
        (['s', 'enter', '+', 'right', 'right', '=', '1', '7', '0', 'enter'], 'read it again'),
        (['s', 's', 's', 'right', '['], 'outside'),
    ],
)
def test_an_answer_that_cannot_be_is_refused_and_nothing_changes(keys, text):
    wizard = begin(chosen=(0,))
    wizard = press(wizard, *keys)
    assert text in wizard.notice
    assert wizard.servos == SERVOS


def test_linear_servos_are_asked_in_millimetres():
    wizard = press(begin(LINEAR, (0,)), 's', '=', '1', '8', '5', 'enter')
    assert wizard.servos[0].centre_mm == 185.0


def test_a_stop_leaves_nothing_to_go_to():
    wizard = begin().press('right').advance(0.02).stopped_at((1502.0, *CENTRES[1:]))
    assert wizard.target == wizard.pulse == 1502.0


def test_counts_stand_in_the_order_of_channels():
    config = machines.read('robocake')
    joints = list(config.servos['joints'])
    joints[0], joints[1] = joints[0] | {'channel': 1}, joints[1] | {'channel': 0}
    turned = BoardConfig.from_machine(
        type(config)(**{**vars(config), 'servos': config.servos | {'joints': joints}})
    ).servos.joints
    wizard = press(ServoWizard.begin(turned, CENTRES, (0,)), 'right')
    assert wizard.counts == (3000, 3040, 3000, 3000, 3000, 3000)


def test_steps_can_be_chosen_within_bounds():
    assert press(begin(), *['+'] * 9).step == STEPS_US[-1]
    assert press(begin(), *['-'] * 9).step == STEPS_US[0]
