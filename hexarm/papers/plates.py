"""Two choices of Lapikov et al. 2014: the same angle on both plates, and plates with thickness.

With φb = φmp the joints of a 6-6 lie on similar hexagons, and its leg Jacobian is singular in
every pose. The experiment of section 4 is done all the same, by the paper's method, with the poses
that fit the leg lengths best.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from hexapod_control.geometry import architecture_sigma
from hexapod_control.leg_motion import PAPER_LENGTH, PAPER_TARGET
from hexapod_control.linear_geometry import joint_circle
from hexarm.papers.finding import LINEAR, Claim, Finding
from hexarm.papers.plane_method import PlaneMethod, PlaneSolution
from manipulator.arrays import Array
from manipulator.errors import NoSolution
from manipulator.pose import Pose

BASE_RADIUS, PLATFORM_RADIUS, HEIGHT = 0.100, 0.050, 0.005
STEPS = 100
EQUAL_DEGREES = (10.0, 20.0, 30.0)
REGULAR_DEGREES = (50.0, 10.0)
DETERMINES = 0.01
"""From which singular value on we call a pose determined by the legs; the shipped 6-6 has 0.2."""
TILT = (0.15, 0.10, 0.05)
SHOWN_TILT, FINE, CORRECTIONS = np.radians(5.0), np.radians(0.05), 3
ROUNDING, RANK = 1e-9, 1e-9
TARGET = Pose(np.array(PAPER_TARGET), np.eye(3))


@dataclass(frozen=True)
class Plates:
    """A 6-6 of the paper's radii with joints at angles φb, φmp (degrees), `height` off plates."""

    base_degrees: float
    platform_degrees: float
    height: float = HEIGHT

    @cached_property
    def base_points(self) -> Array:
        """(6, 3) metres."""
        points = joint_circle(BASE_RADIUS, np.radians(self.base_degrees))
        points[:, 2] += self.height
        return points

    @cached_property
    def platform_points(self) -> Array:
        """(6, 3) metres, platform frame."""
        points = joint_circle(PLATFORM_RADIUS, np.radians(self.platform_degrees))
        points[:, 2] -= self.height
        return points

    @cached_property
    def method(self) -> PlaneMethod:
        """The paper's forward kinematics."""
        angle = float(np.radians(self.platform_degrees))
        return PlaneMethod(self.base_points, PLATFORM_RADIUS, angle, self.height)

    def lengths(self, pose: Pose) -> Array:
        """Of the legs (6,), metres."""
        gaps = pose.transform(self.platform_points) - self.base_points
        return np.asarray(np.linalg.norm(gaps, axis=-1))

    @property
    def start(self) -> Pose:
        """Level, with the paper's leg length on all six legs."""
        across = np.linalg.norm((self.platform_points - self.base_points)[0, :2])
        height = np.sqrt(PAPER_LENGTH**2 - across**2) + 2 * self.height
        return Pose(np.array([0.0, 0.0, height]), np.eye(3))

    def motion(self) -> list[PlaneSolution]:
        """Section 4, each step from the last pose: what fits the linear leg lengths best."""
        found, pose = [], self.start
        for lengths in self.linear_lengths():
            found.append(self.method.nearest(lengths, pose))
            pose = found[-1].pose
        return found

    def linear_lengths(self) -> Array:
        """(101, 6), from the start to the target."""
        return np.linspace(np.full(6, PAPER_LENGTH), self.lengths(TARGET), STEPS + 1)

    def solvable_steps(self) -> int:
        """How many steps have a solution of the nine equations, before the first without one."""
        pose = self.start
        for step, lengths in enumerate(self.linear_lengths()):
            try:
                pose = self.method.solve(lengths, pose).pose
            except NoSolution:
                return step
        return STEPS + 1


def findings() -> Iterator[Finding]:
    """Equal angles: singular, without a solution, off the target; then the plates' thickness."""
    yield singular()
    for degrees in EQUAL_DEGREES:
        yield from equal_motion(degrees)
    yield from thickness()


def singular() -> Finding:
    """The smallest singular value over many poses."""
    angle = np.radians(EQUAL_DEGREES[1])
    sigma = architecture_sigma(
        joint_circle(BASE_RADIUS, angle), joint_circle(PLATFORM_RADIUS, angle)
    )
    return Finding(
        'equal_angles', LINEAR, '6-6 with φb = φmp: σmin of the legs, the largest of many poses',
        Claim('the experiment’s geometry', (DETERMINES,), side='at least'), f'{sigma:.0e}',
        (sigma,), '', 1e-9,
        'similar hexagons: no leg lengths determine the pose; such machine files are rejected',
    )  # fmt: skip


def equal_motion(degrees: float) -> Iterator[Finding]:
    """The experiment with φb = φmp = degrees."""
    plates = Plates(degrees, degrees)
    solvable, found = plates.solvable_steps(), plates.motion()
    misfit = 1e6 * max(s.residual for s in found)
    end = TARGET.twist_to(found[-1].pose)
    off, tilt = 1e3 * float(np.linalg.norm(end[:3])), float(np.degrees(np.linalg.norm(end[3:])))
    name = f'6-6 with φb = φmp = {degrees:g}°'
    yield Finding(
        f'equal_{degrees:g}_steps', LINEAR, f'{name}: steps of 101 with a solution',
        Claim('all', (101.0,), side='at least'), f'{solvable}', (float(solvable),), '', 0.5,
        f'linear leg lengths belong to no pose. The best fit misses them by {misfit:.2f} µm and '
        f'ends {off:.1f} mm off the target, tilted by {tilt:.1f}° (where, depends on rounding)',
    )  # fmt: skip
    other = same_legs(plates, SHOWN_TILT)
    gap, legs = TARGET.twist_to(other), plates.lengths(other) - plates.lengths(TARGET)
    away, wrong = 1e3 * float(np.linalg.norm(gap[:3])), 1e9 * float(np.abs(legs).max())
    x, y, z = 1e3 * other.position
    yield Finding(
        f'equal_{degrees:g}_same_legs', LINEAR, f'{name}: another pose with the target’s legs',
        Claim('the legs give the pose', (0.0,), 0.1, 1.0),
        f'{away:.2f} mm away, tilted by {np.degrees(SHOWN_TILT):.0f}°', (away,), 'mm', 1e-2,
        f'({x:.2f}, {y:.2f}, {z:.2f}) mm: all legs alike within {max(wrong, 0.01):.2g} nm; the '
        'platform moves between such poses while no leg changes',
    )  # fmt: skip


def same_legs(plates: Plates, tilt: float) -> Pose:
    """A pose turned by `tilt` rad against the target, with the same leg lengths.

    Along the direction in which no leg changes, in small steps, each corrected by Newton's method.
    """
    wanted, pose, direction = plates.lengths(TARGET), TARGET, np.eye(6)[3]
    while np.linalg.norm(TARGET.twist_to(pose)[3:]) < tilt - ROUNDING:
        free = np.linalg.svd(leg_slopes(plates, pose))[2][-1]
        direction = free * np.sign(free @ direction) / np.linalg.norm(free[3:])
        left = tilt - float(np.linalg.norm(TARGET.twist_to(pose)[3:]))
        pose = pose.moved(min(FINE, left) * direction)
        for _ in range(CORRECTIONS):
            missing = wanted - plates.lengths(pose)
            pose = pose.moved(np.linalg.pinv(leg_slopes(plates, pose), rcond=RANK) @ missing)
    return pose


def leg_slopes(plates: Plates, pose: Pose) -> Array:
    """How the leg lengths change with the platform's twist (6, 6)."""
    arms = plates.platform_points @ pose.rotation.T
    gaps = pose.position + arms - plates.base_points
    rods = gaps / np.linalg.norm(gaps, axis=-1, keepdims=True)
    return np.hstack([rods, np.cross(arms, rods)])


def thickness() -> Iterator[Finding]:
    """The legs of plates 5 mm thick, read by a model of ideal discs."""
    real, discs = Plates(*REGULAR_DEGREES), Plates(*REGULAR_DEGREES, height=0.0)
    tilted = TARGET.moved(np.array([0.0, 0.0, 0.0, *TILT]))
    for key, words, pose in (('level', 'level', TARGET), ('tilted', 'tilted by 0.19 rad', tilted)):
        seen = discs.method.solve(real.lengths(pose), pose.moved(-2 * HEIGHT * np.eye(6)[2])).pose
        gap = pose.twist_to(seen)
        off, turn = 1e3 * float(np.linalg.norm(gap[:3])), np.degrees(np.linalg.norm(gap[3:]))
        aside = 1e3 * float(np.linalg.norm(gap[:3] + 2 * HEIGHT * np.eye(3)[2]))
        yield Finding(
            f'thickness_{key}', LINEAR, f'ideal discs for plates of 5 mm, {words}: error',
            Claim('matters for accuracy', (0.1,), side='at least'),
            f'{off:.3f} mm and {turn:.3f}°', (off,), 'mm', 1e-3,
            f'{aside:.3f} mm besides the 10 mm by which ideal discs are too low',
        )  # fmt: skip
