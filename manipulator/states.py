"""The states that travel as words: docs/interfaces.md lists where.

They are strings, so that a message holds them as they are and compares equal to the word.
"""

from enum import Enum

UNKNOWN = 'unknown'
"""In place of a machine state, until the first is received."""


class Word(str, Enum):
    """A string whose text is its value."""

    def __str__(self) -> str:
        """The word itself."""
        return str(self.value)

    def __format__(self, spec: str) -> str:
        """The word itself."""
        return format(str(self.value), spec)


class MachineState(Word):
    """The message of `machine_state`: the board mode and the connection in one word."""

    DISCONNECTED = 'disconnected'
    BOOTING = 'booting'
    DISARMED = 'disarmed'
    ARMING = 'arming'
    ENABLED = 'enabled'
    HOLDING = 'holding'
    UNCLAIMED = 'unclaimed'
    PLAYING = 'playing'
    STOPPED = 'stopped'
    FAULT = 'fault'


class MotionResult(Word):
    """The message of `motion_status`: what became of the newest goal."""

    IDLE = 'idle'
    PLANNING = 'planning'
    MOVING = 'moving'
    REACHED = 'reached'
    REFUSED = 'refused'
    STOPPED = 'stopped'


class MotionMode(Word):
    """The value `mode` of `motion_status`."""

    DISABLED = 'disabled'
    HOLD = 'hold'
    MOVE = 'move'
    PATH = 'path'
    CYCLE = 'cycle'
    JOG = 'jog'
