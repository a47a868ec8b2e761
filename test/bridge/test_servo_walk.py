"""The walk through the servos, key by key, without a board."""

import random

import pytest

from bridge.servo_config import BoardConfig
from bridge.servo_walk import SPEED_US_S, STEPS_US, ServoWalk, Stage
from hexarm import machines

SERVOS = BoardConfig.from_machine(machines.read('robocake')).servos.joints
LINEAR = BoardConfig.from_machine(machines.read('stewart_6_6')).servos.joints
CENTRES = (1500.0,) * 6
KEYS = ['right', 'left', '+', '-', 'y', 'n', 'enter', 's', 'b', 'q', 'w', '=', '9', '.', '[', ']']


def begin(servos=SERVOS, chosen=(0, 1)):
    return ServoWalk.begin(servos, CENTRES, chosen)


def settle(walk):
    for _ in range(2000):
        if walk.pulse == walk.target:
            return walk
        walk = walk.advance(0.02)
    raise AssertionError('never arrives')


def press(walk, *keys):
    for key in keys:
        walk = settle(walk.press(key))
    return walk


def test_a_press_moves_one_servo_by_one_step_and_slowly():
    walk = begin().press('right')
    assert walk.target == 1520.0
    walk = walk.advance(0.02)
    assert walk.pulses == (1500.0 + 0.02 * SPEED_US_S, *CENTRES[1:])
    assert settle(walk).pulses == (1520.0, *CENTRES[1:])


def test_a_key_that_is_held_never_runs_ahead_by_more_than_a_step():
    walk = begin()
    for _ in range(30):
        walk = walk.press('right')
    assert walk.target == 1520.0


@pytest.mark.parametrize('seed', range(20))
def test_no_keys_lead_beyond_the_pulse_range_or_move_two_servos_at_once(seed):
    luck = random.Random(seed)
    walk = begin(chosen=(0, 1, 2, 3, 4, 5))
    for _ in range(1500):
        before = walk
        walk = walk.press(luck.choice([*KEYS, *['right'] * 20 * (seed % 2)]))
        if walk.is_over:
            break
        walk = walk.advance(luck.choice([0.02, 0.1]))
        moved = [i for i in range(6) if walk.pulses[i] != before.pulses[i]]
        assert len(moved) <= 1
        assert all(550.0 <= pulse <= 2450.0 for pulse in walk.pulses)
        steps = [abs(a - b) for a, b in zip(walk.pulses, before.pulses, strict=True)]
        assert max(steps) <= 0.1 * SPEED_US_S + 1e-9


def test_sign_centre_scale_and_range_of_one_servo():
    walk = press(begin(chosen=(0,)), 'right', 'n')
    assert walk.stage is Stage.CENTRE
    walk = press(walk, '-', 'left', 'left', 'enter')
    assert walk.stage is Stage.SCALE
    walk = press(walk, '+', '+', *['right'] * 4, '=', '1', '0', '0', 'enter')
    assert walk.stage is Stage.RANGE
    walk = press(walk, *['right'] * 3, ']', 'enter')
    servo = walk.advance(0.02).servos[0]
    assert (servo.sign, servo.centre_us, servo.centre_deg) == (-1, 1510.0, 120.0)
    assert servo.us_per_deg == pytest.approx(200 / 20)
    assert servo.pulse_range_us == (550.0, 1860.0)


def test_the_servo_returns_to_its_new_centre_before_the_next_one_is_asked_for():
    walk = press(begin(), 's', 'right', 'enter', 'right', 's').press('s')
    assert (walk.at, walk.stage) == (0, Stage.RETURN)
    assert walk.target == 1520.0
    walk = settle(walk.advance(0.02))
    assert (walk.at, walk.stage) == (1, Stage.DIRECTION)
    assert walk.pulses == (1520.0, *CENTRES[1:])
    assert walk.target == walk.pulse == 1500.0


@pytest.mark.parametrize(
    ('keys', 'said'),
    [
        (['y'], 'jog it by 20 µs first'),
        (['enter'], 'means nothing here'),
        (['s', '=', '.', 'enter'], 'is no number'),
        (['s', 'enter', '=', '9', '0', 'enter'], 'too near the centre'),
        (['s', 'enter', '+', 'right', 'right', 'right', '=', '9', '0', 'enter'], 'contradicts'),
        (['s', 'enter', '+', 'right', 'right', '=', '1', '7', '0', 'enter'], 'read it again'),
        (['s', 's', 's', 'right', '['], 'outside'),
    ],
)
def test_an_answer_that_cannot_be_is_refused_and_nothing_changes(keys, said):
    walk = begin(chosen=(0,))
    walk = press(walk, *keys)
    assert said in walk.notice
    assert walk.servos == SERVOS


def test_linear_servos_are_asked_in_millimetres():
    walk = press(begin(LINEAR, (0,)), 's', '=', '1', '8', '5', 'enter')
    assert walk.servos[0].centre_mm == 185.0


def test_a_stop_leaves_nothing_to_go_to():
    walk = begin().press('right').advance(0.02).stood((1502.0, *CENTRES[1:]))
    assert walk.target == walk.pulse == 1502.0


def test_counts_stand_in_the_order_of_channels():
    config = machines.read('robocake')
    joints = list(config.servos['joints'])
    joints[0], joints[1] = joints[0] | {'channel': 1}, joints[1] | {'channel': 0}
    turned = BoardConfig.from_machine(
        type(config)(**{**vars(config), 'servos': config.servos | {'joints': joints}})
    ).servos.joints
    walk = press(ServoWalk.begin(turned, CENTRES, (0,)), 'right')
    assert walk.counts == (3000, 3040, 3000, 3000, 3000, 3000)


def test_steps_can_be_chosen_within_bounds():
    assert press(begin(), *['+'] * 9).step == STEPS_US[-1]
    assert press(begin(), *['-'] * 9).step == STEPS_US[0]
