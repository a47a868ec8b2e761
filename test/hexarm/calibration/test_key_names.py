import pytest

from hexarm.calibration.servo_session import key_names


@pytest.mark.parametrize(
    ('characters', 'names'),
    [
        (b'\x1b[C\x1bOD', ('right', 'left')),
        (b'y \r', ('y', 'space', 'enter')),
        (b'=-9.5\x7f\n', ('=', '-', '9', '.', '5', 'backspace', 'enter')),
        (b'\x1b[3~\x1b', ('?', 'escape')),
        (b'\xff', ('�',)),
    ],
)
def test_keys_have_names(characters, names):
    assert key_names(characters) == names


def test_a_paste_is_no_hand_but_a_space_in_it_still_stops():
    assert key_names(b'yyyyyyyyyyyyyyyyyyyy') == ()
    assert key_names(b'the cat walks over the keys') == ('space',)
