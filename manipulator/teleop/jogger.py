"""Following a twist, one tick after the other, within all limits of a machine."""

from dataclasses import dataclass, field
from typing import Protocol

import numpy as np

from manipulator.arrays import Array, frozen
from manipulator.pose import Pose

STRAIGHT = frozen(np.zeros(6))


@dataclass(frozen=True, eq=False)
class JogMotion:
    """Where a jog has come to. Poses and twists are of the pivot in work axes.

    twist (6,) in m/s and rad/s is the one being driven, rates (n,) are the joints' in rad/s or
    m/s. scale is the part of the wanted twist that the machine allows, held_by what set it: '',
    'speed of joint 2', 'crank angle of leg 3', 'wrist singularity (…)'.

    For the jogger's next step: off_line (6,) is the twist that would bring the tool back onto its
    commanded line within a second, in base axes; is_leaving says that it is on its way out of a
    singular posture, off the line.
    """

    pose: Pose
    joints: Array
    twist: Array
    rates: Array
    scale: float = 1.0
    held_by: str = ''
    off_line: Array = field(default_factory=lambda: STRAIGHT)
    is_leaving: bool = False

    @classmethod
    def at_rest(cls, pose: Pose, joints: Array) -> 'JogMotion':
        """Standing still; joints (n,) are the pose's."""
        return cls(pose, joints, frozen(np.zeros(6)), frozen(np.zeros(len(joints))))

    @property
    def is_at_rest(self) -> bool:
        """Whether nothing moves."""
        return not (self.twist.any() or self.rates.any())


class Jogger(Protocol):
    """A kind of machine's way to follow twists; without state of its own."""

    def step(self, motion: JogMotion, twist: Array, dt: float) -> JogMotion:
        """The motion dt seconds later, on its way to the wanted twist (6,).

        The twist is scaled as a whole, so that its direction stays; where it cannot, the machine
        stops, unless held_by says that it slides. A twist of zero brakes. From
        every motion that `step` returned it can brake inside the machine's limits.
        """
        ...
