"""What the arm's part of the demonstration measured, from its true joint angles."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from manipulator import rotation as so3
from manipulator.arrays import Array, Mask
from manipulator.kinematics import Kinematics
from manipulator.pose import Pose

STANDING = 1e-4
"""rad/s below which no joint moves; a count is 1.5e-4 rad."""


@dataclass(frozen=True)
class Phase:
    """What the pad did from `begin` to `end` (Unix time); at the end it was released."""

    name: str
    begin: float
    end: float


@dataclass(frozen=True, eq=False)
class ArmObservation:
    """True joints (n, 6) at Unix times (n,); the point that the tool looked at."""

    times: Array
    joints: Array
    phases: tuple[Phase, ...]
    point: Array

    def during(self, name: str) -> Mask:
        """Which times are in that phase."""
        (phase,) = (p for p in self.phases if p.name == name)
        inside: Mask = (self.times >= phase.begin) & (self.times < phase.end)
        return inside


@dataclass(frozen=True, eq=False)
class ArmResult:
    """turned (n,) in radians while the orientation is held, missed (n,) in metres while the tool
    looks at the point, NaN elsewhere; travel and stop of the joystick's motions.
    """

    observation: ArmObservation
    poses: Pose
    turned: Array
    missed: Array
    travel: float
    stop: float

    def rows(self) -> Iterator[tuple[str, str]]:
        """The table, a line each."""
        degrees, millimetres = np.degrees(self.turned), 1e3 * self.missed
        for name, values, unit in (
            (f'turned, over {self.travel:.2f} m: end, rms, max', degrees, '°'),
            ('point missed by: end, rms, max', millimetres, ' mm'),
        ):
            kept = values[np.isfinite(values)]
            figures = (kept[-1], np.sqrt(np.mean(kept**2)), kept.max())
            yield name, ', '.join(f'{figure:.3f}{unit}' for figure in figures)
        yield 'stick released to standstill, longest', f'{1e3 * self.stop:.0f} ms'


def measure_arm(observation: ArmObservation, kinematics: Kinematics) -> ArmResult:
    """Poses by forward kinematics of the true angles, and what they keep."""
    found = [kinematics.forward(row).pose for row in observation.joints]
    poses = Pose(np.stack([p.position for p in found]), np.stack([p.rotation for p in found]))
    square, look = observation.during('square'), observation.during('look')
    first = poses[int(np.argmax(square))].rotation
    turned = np.linalg.norm(so3.log(poses.rotation @ first.T), axis=-1)
    approach, arm = poses.rotation[:, :, 2], observation.point - poses.position
    missed = np.linalg.norm(np.cross(approach, arm), axis=-1)
    steps = np.linalg.norm(np.diff(poses.position[square], axis=0), axis=-1)
    return ArmResult(
        observation,
        poses,
        np.where(square, turned, np.nan),
        np.where(look, missed, np.nan),
        float(steps.sum()),
        max(_stop(observation, phase) for phase in observation.phases),
    )


def _stop(observation: ArmObservation, phase: Phase) -> float:
    """From the release at the end of a phase to the last motion before the next one."""
    after = (observation.times >= phase.end) & (observation.times < phase.end + 0.35)
    rates = np.abs(np.diff(observation.joints, axis=0)).max(axis=-1) / 0.02
    moving = observation.times[1:][after[1:] & (rates > STANDING)]
    return float(moving[-1] - phase.end) if len(moving) else 0.0
