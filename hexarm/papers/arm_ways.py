"""Three ways to the arm's inverse, compared as Fadeev and Loginov do: by trigonometric calls.

The first solves the forward equations for the joints, the second looks at triangles (the law of
cosines), the third is the paper's: velocities, and a system of equations in each period. All in
the paper's symbols; the first two give the branch with q3 > 0 and q5 > 0.
"""

import math
from collections import Counter
from dataclasses import dataclass, field

import numpy as np

from hexarm.papers.paper_arm import PaperArm
from manipulator.arrays import Array
from manipulator.errors import Unreachable


@dataclass
class Trigonometry:
    """The functions of `math`, which count their calls: a mutable record of one computation."""

    calls: Counter[str] = field(default_factory=Counter)

    def sin(self, angle: float) -> float:
        """Counted as sin."""
        self.calls['sin'] += 1
        return math.sin(angle)

    def cos(self, angle: float) -> float:
        """Counted as cos."""
        self.calls['cos'] += 1
        return math.cos(angle)

    def atan2(self, y: float, x: float) -> float:
        """Counted as atan2."""
        self.calls['atan2'] += 1
        return math.atan2(y, x)

    def acos(self, cosine: float) -> float:
        """Counted as acos."""
        self.calls['acos'] += 1
        return math.acos(cosine)


@dataclass(frozen=True)
class Reach:
    """The wrist centre in the arm's plane: distances across and up from the shoulder, metres."""

    across: float
    up: float
    cosine: float
    """Of q3."""

    @classmethod
    def of(cls, arm: PaperArm, centre: Array) -> 'Reach':
        """For a wrist centre (3,) in the base frame; Unreachable beyond the arm."""
        across, up = math.hypot(centre[0], centre[1]), float(centre[2]) - arm.L1
        cosine = (across**2 + up**2 - arm.L2**2 - arm.L3**2) / (2 * arm.L2 * arm.L3)
        if not (abs(cosine) < 1.0 and across > 0.0):
            raise Unreachable(
                f'wrist centre {across:.4g} m across, {up:.4g} m up: beyond the arm or on its axis'
            )
        return cls(across, up, cosine)


def by_equations(arm: PaperArm, centre: Array, rotation: Array, use: Trigonometry) -> Array:
    """Joints (6,) from eq. (1) and R06, solved for sines and cosines before any angle."""
    at = Reach.of(arm, centre)
    c3, s3 = at.cosine, math.sqrt(1.0 - at.cosine**2)
    along, aside = arm.L2 + arm.L3 * c3, arm.L3 * s3
    size = along**2 + aside**2
    s2 = (along * at.across - aside * at.up) / size
    c2 = (along * at.up + aside * at.across) / size
    s1, c1 = -centre[0] / at.across, centre[1] / at.across
    column, row = _wrist(s1, c1, s2 * c3 + c2 * s3, c2 * c3 - s2 * s3, rotation)
    bent = math.hypot(column[0], column[1])
    return np.array(
        [
            use.atan2(-centre[0], centre[1]),
            use.atan2(s2, c2),
            use.atan2(s3, c3),
            use.atan2(-column[0], column[1]),
            use.atan2(bent, column[2]),
            use.atan2(-row[0], -row[1]),
        ]
    )


def by_triangles(arm: PaperArm, centre: Array, rotation: Array, use: Trigonometry) -> Array:
    """Joints (6,) from the triangle of upper arm, forearm and the line to the wrist centre."""
    at = Reach.of(arm, centre)
    distance = math.hypot(at.across, at.up)
    at_shoulder = (arm.L2**2 + distance**2 - arm.L3**2) / (2 * arm.L2 * distance)
    q1 = use.atan2(-centre[0], centre[1])
    q2 = math.pi / 2 - use.atan2(at.up, at.across) - use.acos(at_shoulder)
    q3 = math.pi - use.acos(-at.cosine)
    column, row = _wrist(
        use.sin(q1), use.cos(q1), use.sin(q2 + q3), use.cos(q2 + q3), rotation
    )  # fmt: skip
    q4, q5 = use.atan2(-column[0], column[1]), use.acos(column[2])
    return np.array([q1, q2, q3, q4, q5, use.atan2(-row[0], -row[1])])


def by_velocities(q: Array, use: Trigonometry, with_orientation: bool = True) -> None:
    """The values that a step of the paper's method computes at joints (6,); counted only.

    s1, c1, s2, c2, s23, c23 for the position; of q4, q5 and q6 as well for the orientation.
    """
    angles = [q[0], q[1], q[1] + q[2], *(q[3:] if with_orientation else [])]
    for angle in angles:
        use.sin(angle)
        use.cos(angle)


def _wrist(s1: float, c1: float, s23: float, c23: float, r: Array) -> tuple[Array, Array]:
    """Third column and third row of Rz(q4)·Rx(−q5)·Rz(q6), the tool seen from the forearm."""
    forearm = np.array([[c1, s1, 0.0], [-s1 * c23, c1 * c23, -s23], [-s1 * s23, c1 * s23, c23]])
    seen = forearm @ r
    return seen[:, 2], seen[2]
