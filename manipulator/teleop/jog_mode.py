"""What a jog mode is: a reference latched when motion begins, and a loop closed on it."""

from typing import Protocol

from manipulator.arrays import Array
from manipulator.pose import Pose


class Held(Protocol):
    """A mode in motion, with its reference. A value: `step` returns its successor.

    Twists are (6,), of the tool in base axes, in m/s and rad/s.
    """

    def step(self, command: Array, measured: Pose, commanded: Array) -> 'tuple[Array, Held]':
        """The twist to drive for the operator's command, and the mode for the next tick.

        What was held is compared with the measured pose, which may be late by the delay for which
        the mode's feedback was chosen. What is known beforehand is reckoned from `commanded`
        (3,), where the tool's position is commanded to be midway through the coming tick.
        """
        ...


class JogMode(Protocol):
    """A mode at rest."""

    def latched(self, pose: Pose) -> Held:
        """The mode in motion, its reference taken from the pose at which motion begins.

        Raises Refused where the mode has no meaning.
        """
        ...
