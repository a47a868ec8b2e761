from dataclasses import fields
from pathlib import Path

import pytest

from hexarm.gamepads import load, shipped
from hexarm.machines import find
from manipulator.config import build
from manipulator.errors import ConfigError
from manipulator.teleop.gamepad import Gamepad, Stick

LEAST = {
    'description': 'one stick',
    'deadman': {'button': 0},
    'sticks': [{'axis': 0, 'moves': 'x', 'full_speed': 0.1}],
}


def test_shipped_mappings_drive_all_six_components_under_a_deadman():
    assert set(shipped()) == {'xbox', 'playstation'}
    for name in shipped():
        gamepad = load(name)
        assert {stick.moves for stick in gamepad.sticks} == {
            'x', 'y', 'z', 'roll', 'pitch', 'yaw',
        }  # fmt: skip
        assert {'deadman', 'stop', 'home', 'slow', 'turbo'} <= gamepad.presses.keys()


def test_unknown_gamepad_names_the_nearest():
    with pytest.raises(ConfigError, match="'xbix', did you mean 'xbox'"):
        load('xbix')


def test_a_machine_file_is_no_mapping():
    with pytest.raises(ConfigError) as caught:
        load(str(find('robocake')))
    assert caught.value.problems == (
        'this is no mapping of a gamepad: deadman, sticks are missing',
    )


def test_mapping_is_loaded_by_path(tmp_path):
    path = tmp_path / 'mine.yaml'
    path.write_text('description: mine\ndeadman: {button: 0}\nsticks: []\n')
    with pytest.raises(ConfigError, match=r'mine\.yaml: sticks: empty'):
        load(str(path))


@pytest.mark.parametrize(
    ('wrong', 'said'),
    [
        ({'deadmen': {'button': 1}}, "deadmen: unknown key, did you mean 'deadman'"),
        ({'deadman': {'button': 1, 'axis': 2}}, 'deadman: needs either button or axis'),
        ({'deadman': {}}, 'deadman: needs either button or axis'),
        ({'deadman': {'axis': 5, 'rest': 1.0, 'beyond': 0.9}}, 'deadman: beyond: 0.9 is within'),
        ({'deadman': {'button': -1}}, 'deadman.button: -1 outside'),
        ({'stop': {'button': 0}}, 'button 0: has 2 meanings'),
        ({'modes': ['free', 'hold_orientatoin']}, "did you mean 'hold_orientation'"),
        ({'frames': ['tol']}, "did you mean 'tool'"),
        ({'frames': []}, 'frames: empty'),
        ({'lost_after': 3.0}, 'lost_after: 3 outside'),
        (
            {'sticks': [{'axis': 0, 'moves': 'x', 'full_speed': 0.1, 'layer': 'shift'}]},
            'shift: missing',
        ),
    ],
)
def test_wrong_mapping_is_refused_by_name(wrong, said):
    build(Gamepad, LEAST)
    with pytest.raises(ConfigError) as caught:
        build(Gamepad, LEAST | wrong)
    assert said in str(caught.value)


def test_every_key_of_a_mapping_is_documented():
    text = (Path(__file__).resolve().parents[3] / 'docs' / 'joystick.md').read_text()
    keys = {field.name for schema in (Gamepad, Stick) for field in fields(schema)}
    assert {key for key in keys - {'description'} if f'`{key}`' not in text} <= {'axis', 'moves'}
