import pytest
from hypothesis import given
from hypothesis import strategies as st

from manipulator.teleop.keyboard import HELP, MOVES, UNKNOWN, Keyboard, keys_of


@pytest.fixture
def keyboard():
    return Keyboard(0.02, 0.2)


def test_a_press_moves_for_three_tenths_of_a_second(keyboard):
    pressed = keyboard.press('w', 10.0)
    assert pressed.twist(10.29).tolist() == [0.02, 0, 0, 0, 0, 0]
    assert pressed.is_held(10.29)
    assert not pressed.is_held(10.31)
    assert not pressed.twist(10.31).any()


def test_auto_repeat_extends_the_motion(keyboard):
    for i in range(20):
        keyboard = keyboard.press('j', 10.0 + 0.1 * i)
    assert keyboard.twist(12.1)[5] == pytest.approx(0.2)
    assert not keyboard.is_held(12.3)


@pytest.mark.parametrize('key', MOVES)
def test_every_key_moves_one_component_and_its_opposite_replaces_it(keyboard, key):
    one_way = keyboard.press(key, 0.0).twist(0.1)
    assert sum(one_way != 0) == 1
    opposite = next(k for k in MOVES if k != key and MOVES[k][0] == MOVES[key][0])
    assert (keyboard.press(key, 0.0).press(opposite, 0.05).twist(0.1) == -one_way).all()


def test_keys_of_different_components_add_up(keyboard):
    twist = keyboard.press('w', 0.0).press('r', 0.1).twist(0.2)
    assert twist.tolist() == [0.02, 0, 0.02, 0, 0, 0]


@pytest.mark.parametrize('key', [' ', UNKNOWN, 'W', 'x', '\n', 'm', 'b', 'h', 'p'])
def test_any_other_key_ends_the_motion(keyboard, key):
    assert not keyboard.press('w', 0.0).press(key, 0.1).is_held(0.1)


def test_space_home_and_saving_are_counted(keyboard):
    pressed = keyboard.press(' ', 0.0).press(' ', 0.1).press('h', 0.2)
    assert (pressed.stops, pressed.homes, pressed.saves) == (2, 1, 0)
    assert pressed.press('p', 0.3).saves == 1


def test_speed_keys_change_the_speed_within_bounds(keyboard):
    assert keyboard.press('+', 0.0).press('w', 0.0).twist(0.1)[0] == pytest.approx(0.025)
    slowest, fastest = keyboard, keyboard
    for _ in range(50):
        slowest, fastest = slowest.press('-', 0.0), fastest.press('+', 0.0)
    assert slowest.press('w', 0.0).twist(0.1)[0] == pytest.approx(0.001)
    assert fastest.press('w', 0.0).twist(0.1)[0] == pytest.approx(0.1)


def test_speed_keys_do_not_interrupt_the_motion(keyboard):
    assert keyboard.press('w', 0.0).press('-', 0.1).is_held(0.2)


def test_modes_and_frames_go_round(keyboard):
    assert keyboard.press('m', 0.0).mode == 'hold_orientation'
    assert keyboard.press('n', 0.0).mode == 'look_at'
    assert keyboard.press('b', 0.0).frame == 'tool'
    assert keyboard.press('b', 0.0).press('b', 0.1).frame == 'base'


def test_gripper_keys_exclude_each_other(keyboard):
    assert keyboard.press('v', 0.0).grip(0.1) == 1
    assert keyboard.press('v', 0.0).press('c', 0.1).grip(0.2) == -1
    assert keyboard.press('v', 0.0).grip(0.4) == 0


def test_arrow_keys_are_not_taken_for_the_letters_at_their_ends():
    assert keys_of(b'\x1b[A') == (UNKNOWN,)
    assert keys_of(b'\x1bOa') == (UNKNOWN,)
    assert keys_of(b'\x1b[3~w') == (UNKNOWN, 'w')
    assert keys_of(b'\x1b') == (UNKNOWN,)


def test_repeated_keys_are_typing_and_a_text_is_not():
    assert keys_of(b'wwwwwwww') == ('w',) * 8
    assert keys_of(b'rm -rf somewhere\n') == (UNKNOWN,)


def test_help_fits_one_screen_and_names_every_key():
    lines = HELP.splitlines()
    assert len(lines) < 20
    assert max(map(len, lines)) < 80
    assert all(key in HELP for key in (*MOVES, 'SPACE', 'v', 'c', 'm', 'n', 'b', 'h', 'q'))


@given(st.binary(max_size=40), st.floats(0.0, 1.0))
def test_no_bytes_move_longer_than_one_press_may(characters, later):
    keyboard = Keyboard(0.02, 0.2)
    for key in keys_of(characters):
        keyboard = keyboard.press(key, 0.0)
    assert keyboard.is_held(later) <= (later < 0.3)
    assert (abs(keyboard.twist(later)) <= [0.1] * 3 + [1.0] * 3).all()
