"""Arms as their sources print them, for models in other libraries that owe nothing to our code.

Rows are standard Denavit–Hartenberg: a (m), alpha (rad), d (m); a link is
Rz(q)·Tz(d)·Tx(a)·Rx(alpha), and the tool is the last frame.
"""

from dataclasses import dataclass

import numpy as np

QUARTER = np.pi / 2

UR5 = (  # Universal Robots, "DH Parameters for calculations of kinematics and dynamics"
    (0.0, QUARTER, 0.089159),
    (-0.425, 0.0, 0.0),
    (-0.39225, 0.0, 0.0),
    (0.0, QUARTER, 0.10915),
    (0.0, -QUARTER, 0.09465),
    (0.0, 0.0, 0.0823),
)
PUMA560 = (  # P. Corke, B. Armstrong-Hélouvry, ICRA 1994
    (0.0, QUARTER, 0.67183),
    (0.4318, 0.0, 0.0),
    (0.0203, -QUARTER, 0.15005),
    (0.0, QUARTER, 0.4318),
    (0.0, -QUARTER, 0.0),
    (0.0, 0.0, 0.0),
)
SKEW_PUMA = (*PUMA560[:4], (0.01, -QUARTER, 0.0), PUMA560[5])
"""No three axes meet, none but two are parallel: without a closed form."""

TABLES = {'ur5': UR5, 'puma560': PUMA560, 'skew_puma': SKEW_PUMA}


@dataclass(frozen=True)
class Link:
    """Where the next frame is in a link's own, which turns with its joint about z."""

    position: tuple[float, float, float]
    alpha: float


def links(name: str) -> list[Link]:
    """Of an arm by its name, base first."""
    return [Link((a, 0.0, d), alpha) for a, alpha, d in TABLES[name]]
