"""How messages write lengths, counts and the reasons of the operating system.

Numbers that look as if they were meant in another unit: the hint that a refusal ends with.

What to say when a library that only some commands need is not installed.
"""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from math import pi, radians

import numpy as np

from manipulator.errors import InvalidInput, Unreachable
from manipulator.kinematics import Kinematics
from manipulator.pose import Pose

MOST_SHOWN = 80
"""Characters of an input that a message repeats."""

METRES_FROM = 0.9999
"""m. Shorter ones are told in millimetres."""


def length(metres: float, digits: int = 4) -> str:
    """A length for people, without powers of ten: '22.8 mm', from a metre on '45.2 m'."""
    value, unit = (metres, 'm') if abs(metres) > METRES_FROM else (1e3 * metres, 'mm')
    written = f'{float(f"{value:.{digits}g}"):.10f}'.rstrip('0').rstrip('.')
    return f'{written} {unit}'


def counted(count: int, one: str, many: str = '') -> str:
    """A count and its noun: '1 pose', '2,000 poses'; `many` where it is not one with an s."""
    return f'{count:,} {one if count == 1 else many or one + "s"}'


def shown(value: object, most: int = MOST_SHOWN) -> str:
    """An input as a message repeats it: as Python writes it, its beginning where it is long."""
    return shortened(repr(value[: most + 1] if isinstance(value, str) else value), most)


def shortened(text: str, most: int = MOST_SHOWN) -> str:
    """A text, or the beginning of a long one and that it is cut."""
    return text if len(text) <= most else f'{text[:most]}…'


def reason(error: Exception) -> str:
    """Why a file could not be used, without numbers of errors and the file's name again."""
    if isinstance(error, UnicodeDecodeError):
        return f'it is no text (byte {error.start})'
    return (isinstance(error, OSError) and error.strerror) or str(error)


FAR = 20.0
"""Characteristic lengths from home beyond which millimetres are more likely than metres."""

A_TURN = 2 * pi + 1e-3
TURNS = ('roll', 'pitch', 'yaw')


@contextmanager
def hint_at_metres(kinematics: Kinematics, pose: Pose) -> Iterator[None]:
    """Adds to an Unreachable of a pose that is far away whether millimetres were meant."""
    try:
        yield
    except Unreachable as error:
        away = np.linalg.norm(pose.position - kinematics.home.position)
        if away > FAR * kinematics.characteristic_length:
            error.args = (f'{error}; are these millimetres? hexarm takes metres',)
        raise


def check_turns(angles: Sequence[float], names: Sequence[str] = TURNS) -> None:
    """Raises InvalidInput for angles of more than a turn: they are meant in degrees."""
    for name, value in zip(names, angles, strict=True):
        if abs(value) > A_TURN:
            raise InvalidInput(
                f'{name}: {value:g} rad is more than a turn; are these degrees? hexarm takes '
                f'radians: {value:g}° are {radians(value):.4g}'
            )


INSTALL = {
    'ruckig': 'python3 -m pip install ruckig',
    'serial': 'python3 -m pip install pyserial',
    'evdev': 'python3 -m pip install evdev, or apt install python3-evdev (Linux)',
    'matplotlib': 'python3 -m pip install matplotlib',
    'mujoco': 'python3 -m pip install mujoco',
    'rich': 'python3 -m pip install rich',
    'mcap': 'python3 -m pip install mcap',
    'mcap_ros2': 'python3 -m pip install mcap-ros2-support',
    'PIL': 'python3 -m pip install pillow',
    'viser': "python3 -m pip install 'viser>=1.1,<1.2'",
    'scipy': 'python3 -m pip install scipy, or apt install python3-scipy',
    'rclpy': 'install ROS 2 Jazzy and source its setup.bash, or pip install hexarm[ros]',
}


def missing(error: ModuleNotFoundError) -> str:
    """One sentence with the way out; a module that is not ours to name is raised again."""
    name = (error.name or '').split('.')[0]
    if name not in INSTALL:
        raise error
    return f'needs the Python module {name}: {INSTALL[name]}'
