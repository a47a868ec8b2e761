"""The motion experiment of Lapikov et al. 2014, section 4, and what the paper concludes."""

from collections.abc import Iterator

import numpy as np

from hexapod_control.assembly_modes import modes_of
from hexapod_control.geometry import architecture_sigma
from hexapod_control.leg_motion import LegMotion, paper_motion
from hexapod_control.linear import LinearPlatform
from hexapod_control.linear_geometry import PlatesConfig, joint_circle
from hexarm import machines
from hexarm.papers.finding import LINEAR, Finding
from hexarm.papers.plane_method import PlaneMethod
from manipulator.arrays import Array
from manipulator.config import build
from manipulator.errors import InvalidInput
from manipulator.pose import Pose

MACHINES = {'6-3': 'stewart_6_3', '6-6': 'stewart_6_6'}


def motion(name: str) -> LegMotion:
    """The experiment on a shipped machine, by Newton's method."""
    kinematics = _platform(name)

    def solve(lengths: Array, near: Pose) -> Pose:
        return kinematics.forward(lengths, near).pose

    return paper_motion(kinematics.geometry, solve)


def findings() -> Iterator[Finding]:
    """Both platforms, the plane method, the equal hexagons, the many solutions."""
    heights = {}
    for kind, name in MACHINES.items():
        found = motion(name)
        heights[kind] = 1e3 * float(found.poses.position[0, 2])
        off, turn = (
            1e3 * float(found.position_deviation.max()),
            float(np.degrees(found.angle_deviation.max())),
        )
        yield Finding(
            f'linear_{kind}', LINEAR, f'{kind}: linear legs give a linear pose', 'yes',
            f'deviates by up to {off:.3f} mm and {turn:.4f}°', off, 1e-3, 'partly',
            'approximately; the angles φ are lost in the scan, ours are in the machine file',
        )  # fmt: skip
    apart = heights['6-6'] - heights['6-3']
    yield Finding(
        'heights', LINEAR, 'same leg lengths, different heights of 6-3 and 6-6', 'yes',
        f'{heights["6-3"]:.3f} and {heights["6-6"]:.3f} mm', apart, 1e-3, 'agrees',
        'the platform’s joints are at other positions',
    )  # fmt: skip
    yield _plane_method()
    yield _equal_angles()
    yield _solutions()


def _plane_method() -> Finding:
    """The paper's nine equations against six, along the whole experiment."""
    worst = 0.0
    for name in MACHINES.values():
        plates = build(PlatesConfig, machines.read(name).geometry)
        plane, kinematics = PlaneMethod.of(plates), _platform(name)
        there = paper_motion(kinematics.geometry, lambda q, near: plane.solve(q, near).pose)  # noqa: B023
        gap = there.poses.twist_to(motion(name).poses)
        worst = max(worst, float(np.abs(gap).max()))
    return Finding(
        'plane_method', LINEAR, 'forward kinematics by the plane of three points', 'works',
        f'differs from ours by {1e6 * worst:.1g} µm or µrad at most', 1e6 * worst, 1e-2, 'agrees',
        'nine unknowns instead of six, the same pose at all 101 steps',
    )  # fmt: skip


def _equal_angles() -> Finding:
    """φb = φmp, as the paper has it: similar hexagons."""
    angle = np.radians(20.0)
    sigma = architecture_sigma(joint_circle(0.1, angle), joint_circle(0.05, angle))
    return Finding(
        'equal_angles', LINEAR, '6-6 with φb = φmp', 'the experiment’s geometry',
        f'σmin = {sigma:.0e} in every pose', sigma, 1e-9, 'contradicts',
        'similar hexagons: no leg lengths determine the pose; such files are rejected',
    )  # fmt: skip


def _solutions() -> Finding:
    """Real poses for one set of leg lengths."""
    kinematics = _platform('stewart_6_6')
    modes = modes_of(kinematics, kinematics.inverse(kinematics.home))
    return Finding(
        'solutions', LINEAR, 'solutions of the forward problem', 'up to 40; the nearest is taken',
        f'{modes.complex_count} in all, {len(modes.poses)} real at home', len(modes.poses), 0.0,
        'agrees', 'all computed at once: [forward-modes.md](forward-modes.md)',
    )  # fmt: skip


def _platform(name: str) -> LinearPlatform:
    kinematics = machines.load(name).kinematics
    if not isinstance(kinematics, LinearPlatform):
        raise InvalidInput(f'{name} is no linear platform')
    return kinematics
