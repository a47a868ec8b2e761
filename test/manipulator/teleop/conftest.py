"""A gamepad whose user presses and pushes by name."""

from dataclasses import dataclass, field, replace

import pytest

from hexarm.gamepads import load
from manipulator.teleop.joy_reader import JoyReader

LB, RB, STOP, HOME, FRAME, CLOSE, OPEN = 4, 5, 1, 7, 2, 0, 3
"""Buttons of the Xbox mapping."""

X, Y, SLOW, YAW, Z, TURBO, CROSS = 1, 0, 2, 3, 4, 5, 6
"""Its axes."""

PERIOD = 0.02


@dataclass
class User:
    """Holds an Xbox pad whose messages come every 20 ms."""

    reader: JoyReader
    now: float = 100.0
    axes: list[float] = field(default_factory=lambda: [0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0])
    buttons: list[int] = field(default_factory=lambda: [0] * 11)

    def send(self):
        """One message of the present state; what is command right after it."""
        self.now += PERIOD
        self.reader = self.reader.receive(self.axes, self.buttons, self.now)
        return self.command

    def push(self, **axes):
        """Moves axes by name and sends."""
        for name, value in axes.items():
            self.axes[globals()[name]] = value
        return self.send()

    def press(self, *buttons):
        """Presses buttons and sends."""
        for button in buttons:
            self.buttons[button] = 1
        return self.send()

    def release(self, *buttons):
        """Releases buttons and sends."""
        for button in buttons:
            self.buttons[button] = 0
        return self.send()

    def hold(self, seconds, tremor=0.0):
        """Sends the same again and again, with a thumb that trembles by so much."""
        for i in range(round(seconds / PERIOD)):
            self.axes[7] = tremor * (i % 2)
            command = self.send()
        return command

    @property
    def command(self):
        return self.reader.command(self.now)


@pytest.fixture
def gamepad():
    return load('xbox')


@pytest.fixture
def user(gamepad):
    """A user who has put the pad down untouched."""
    user = User(JoyReader(gamepad))
    user.send()
    return user


@pytest.fixture
def driver(user):
    """A user who drives along x at full speed."""
    user.press(LB)
    user.push(X=1.0)
    return user


@pytest.fixture
def changed(gamepad):
    """Makes a reader of the mapping with other options."""
    return lambda **options: JoyReader(replace(gamepad, **options))
