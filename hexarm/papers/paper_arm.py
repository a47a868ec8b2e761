"""The arm in the paper's own formulas: Fadeev and Loginov, eq. (1) and the projections.

Angles q (..., 6) in radians, lengths L1, L2, L3 in metres; straight up at q = 0. The tool's unit
vectors are a (approach), n and s = a × n: the z, −y and x axes of
R06 = Rz(q1)·Rx(−q2)·Rx(−q3)·Rz(q4)·Rx(−q5)·Rz(q6).

The differential method of Fadeev and Loginov: position first, then three projections.

It has singularities that the arm has not (a_y = 0, s_z = 0), and its correction of the whole
error in one period diverges over a delay. So it stands here to be compared with; the nodes jog
with resolved_rate.py.
"""

from dataclasses import dataclass

import numpy as np

from manipulator.arrays import Array
from manipulator.errors import NoSolution


@dataclass(frozen=True)
class PaperArm:
    """L1 base to shoulder, L2 shoulder to elbow, L3 elbow to wrist centre C, in metres."""

    L1: float
    L2: float
    L3: float

    def position(self, q: Array) -> Array:
        """C in the base frame (..., 3): eq. (1)."""
        s, c, s23, c23 = _sines_and_cosines(q)
        across = self.L2 * s[1] + self.L3 * s23
        up = self.L1 + self.L2 * c[1] + self.L3 * c23
        return np.stack([-s[0] * across, c[0] * across, up], axis=-1)

    def position_rates(self, q: Array) -> Array:
        """The coefficients of q1', q2', q3' in X', Y', Z': rows α, β, γ of (..., 3, 3)."""
        s, c, s23, c23 = _sines_and_cosines(q)
        across, fore = self.L2 * s[1] + self.L3 * s23, self.L3 * c23
        along = self.L2 * c[1] + fore
        rows = [
            [-c[0] * across, -s[0] * along, -s[0] * fore],
            [-s[0] * across, c[0] * along, c[0] * fore],
            [0.0 * across, -across, -self.L3 * s23],
        ]
        return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)


def projections(q: Array) -> Array:
    """a_x, a_z and n_z (..., 3).

    a_x is printed with the opposite sign, which contradicts eq. (1): at q4 = q5 = q6 = 0 the
    approach axis must lie along the forearm, whose X is −s1·s23.
    """
    s, c, s23, c23 = _sines_and_cosines(q)
    a_x = -(c[0] * s[3] * s[4] + s[0] * c23 * c[3] * s[4] + s[0] * s23 * c[4])
    a_z = -s23 * c[3] * s[4] + c23 * c[4]
    n_z = -s23 * s[3] * s[5] + c[5] * (s23 * c[3] * c[4] + c23 * s[4])
    return np.stack([a_x, a_z, n_z], axis=-1)


def nine_projections(three: Array, near: Array) -> Array:
    """a, n, s as rows (3, 3) from a_x, a_z, n_z (3,): of the four solutions the nearest to `near`.

    "The others are easily computed": a_y = ±√(1 − a_x² − a_z²), n is square to a, s = a × n. So
    the three do not give the orientation alone. NoSolution for values that no rotation has.
    """
    a_x, a_z, n_z = (float(v) for v in three)
    level = 1.0 - a_z**2
    rest = level - n_z**2
    if a_x**2 > level or rest < 0.0 or level <= 0.0:
        raise NoSolution(f'no rotation has a_x {a_x:g}, a_z {a_z:g}, n_z {n_z:g}')
    solutions = []
    for sign in (1.0, -1.0):
        a = np.array([a_x, sign * np.sqrt(level - a_x**2), a_z])
        along, across = a[:2] / np.sqrt(level), np.array([-a[1], a[0]]) / np.sqrt(level)
        lean, side = -a_z * n_z / np.sqrt(level), np.sqrt(rest / level)
        for other in (side, -side):
            n = np.array([*(lean * along + other * across), n_z])
            solutions.append(np.stack([a, n, np.cross(a, n)]))
    return min(solutions, key=lambda found: float(np.abs(found - near).sum()))


def projection_rates(q: Array) -> Array:
    """The coefficients of q1' … q6' in a_x', a_z', n_z': rows α, β, γ of (..., 3, 6)."""
    s, c, s23, c23 = _sines_and_cosines(q)
    zero = 0.0 * s23
    wrist = s23 * c[3] * c[4] + c23 * s[4]
    a_x = [
        s[0] * s[3] * s[4] - c[0] * (c23 * c[3] * s[4] + s23 * c[4]),
        s[0] * (s23 * c[3] * s[4] - c23 * c[4]),
        s[0] * (s23 * c[3] * s[4] - c23 * c[4]),
        (s[0] * c23 * s[3] - c[0] * c[3]) * s[4],
        -(c[0] * s[3] + s[0] * c23 * c[3]) * c[4] + s[0] * s23 * s[4],
        zero,
    ]
    a_z_23 = -c23 * c[3] * s[4] - s23 * c[4]
    a_z = [zero, a_z_23, a_z_23, s23 * s[3] * s[4], -s23 * c[3] * c[4] - c23 * s[4], zero]
    n_z_23 = -c23 * s[3] * s[5] + c[5] * (c23 * c[3] * c[4] - s23 * s[4])
    n_z = [
        zero,
        n_z_23,
        n_z_23,
        -s23 * (c[3] * s[5] + s[3] * c[4] * c[5]),
        c[5] * (c23 * c[4] - s23 * c[3] * s[4]),
        -s23 * s[3] * c[5] - s[5] * wrist,
    ]
    return np.stack([np.stack(row, axis=-1) for row in (a_x, a_z, n_z)], axis=-2)


def position_rates_factors(arm: PaperArm, q: Array) -> dict[str, float]:
    """The factors, by name, that make det(position_rates) / (L2·L3·(L2 + L3)) at joints (6,)."""
    s, _, s23, _ = _sines_and_cosines(q)
    across = (arm.L2 * s[1] + arm.L3 * s23) / (arm.L2 + arm.L3)
    return {
        'elbow stretched or folded, sin q3': float(s[2]),
        "wrist centre on joint 1's axis, its distance by L2 + L3": float(across),
    }


def wrist_factors(q: Array) -> dict[str, float]:
    """The factors, by name, that make the determinant of the columns of q4', q5', q6' (6,).

    det = s5 · a_y · s_z: only s5 = 0 is the wrist's own singularity.
    """
    s, c, s23, c23 = _sines_and_cosines(q)
    a_y = c[0] * (c23 * c[3] * s[4] + s23 * c[4]) - s[0] * s[3] * s[4]
    s_z = -s23 * s[3] * c[5] - s[5] * (s23 * c[3] * c[4] + c23 * s[4])
    return {
        'wrist aligned, sin q5': float(s[4]),
        'projections singular though the wrist is not, a_y': float(a_y),
        'projections singular though the wrist is not, s_z': float(s_z),
    }


def _sines_and_cosines(q: Array) -> tuple[list[Array], list[Array], Array, Array]:
    sines, cosines = np.moveaxis(np.sin(q), -1, 0), np.moveaxis(np.cos(q), -1, 0)
    elbow = q[..., 1] + q[..., 2]
    return list(sines), list(cosines), np.sin(elbow), np.cos(elbow)


SINGULAR = 1e-6
"""Factor of a determinant, dimensionless, below which its system is not solved."""


def velocity_towards(target: Array, present: Array, period: float) -> Array:
    """X' = (X_n − X_{n−1}) / T, m/s; the present position is measured where it can be."""
    return (np.asarray(target) - np.asarray(present)) / period


def joint_rates(arm: PaperArm, q: Array, velocity: Array, turning: Array | None = None) -> Array:
    """q1' … q6' in rad/s for the velocity of C (3,) in m/s, at joints (6,).

    turning is (a_x', a_z', n_z') in 1/s, zero by default: the orientation is kept. Raises
    NoSolution, naming the factor of the determinant that vanishes, and whether the arm itself is
    singular there or only these three projections are.
    """
    _check(position_rates_factors(arm, q))
    first = np.linalg.solve(arm.position_rates(q), velocity)
    _check(wrist_factors(q))
    rates = projection_rates(q)
    wanted = np.zeros(3) if turning is None else turning
    last = np.linalg.solve(rates[:, 3:], wanted - rates[:, :3] @ first)
    return np.concatenate([first, last])


def _check(factors: dict[str, float]) -> None:
    for name, value in factors.items():
        if abs(value) < SINGULAR:
            raise NoSolution(f'{name}: {value:.3g}, needs {SINGULAR:g} or more')
