"""The motion experiment of Lapikov et al. 2014, section 4, and what the paper concludes."""

from collections.abc import Iterator

import numpy as np

from hexapod_control.assembly_modes import modes_of
from hexapod_control.leg_motion import LegMotion, paper_motion
from hexapod_control.linear import LinearPlatform
from hexapod_control.linear_geometry import PlatesConfig
from hexarm import machines
from hexarm.papers.finding import LINEAR, Claim, Finding, minus, unstated
from hexarm.papers.plane_method import PlaneMethod
from manipulator.analysis.inside import ranges
from manipulator.arrays import Array
from manipulator.config import build
from manipulator.errors import InvalidInput
from manipulator.machine import Machine, MachineFile
from manipulator.pose import Pose

MACHINES = {'6-3': 'stewart_6_3', '6-6': 'stewart_6_6'}
FIGURES = {'6-3': ('6', '7'), '6-6': ('8', '9')}
LINEAR_MM, NEARLY_MM = 0.1, 3.3
"""Linear within a tenth of a millimetre; nearly, within a twentieth of the way of 66 mm."""
SHOWN_DEGREES = 1.0
"""The axes of figs 7 and 9 end at ±1; the scan shows no finer scale."""
HIGHER_MM = 0.1
SECTIONS = (3, 4)
"""As config/stack_6_6.yaml, and as the LX-4, which the paper names."""
GAIN_AXES = ('x', 'y', 'z', 'roll', 'pitch')
"""About z a stack turns as far as it is looked for."""


def motion(name: str) -> LegMotion:
    """The experiment on a shipped machine, by Newton's method."""
    kinematics = platform(name)

    def solve(lengths: Array, near: Pose) -> Pose:
        return kinematics.forward(lengths, near).pose

    return paper_motion(kinematics.geometry, solve)


def findings() -> Iterator[Finding]:
    """Both platforms, their angles, the plane method, the many solutions."""
    heights = {}
    for kind, name in MACHINES.items():
        found = motion(name)
        heights[kind] = 1e3 * float(found.poses.position[0, 2])
        yield linearity(kind, found)
        yield angles(kind, found)
    apart = heights['6-6'] - heights['6-3']
    yield Finding(
        'heights', LINEAR, 'same leg lengths, other heights of 6-3 and 6-6 (figs 6, 8)',
        Claim('other', (HIGHER_MM,), side='at least'),
        f'{heights["6-3"]:.3f} and {heights["6-6"]:.3f} mm', (abs(apart),), 'mm', 1e-3,
        'the platform’s joints are at other positions',
    )  # fmt: skip
    yield plane_method()
    yield solutions()
    alone = _spans(machines.load('stewart_6_6'))
    for count in SECTIONS:
        yield multi_section(count, alone)


def linearity(kind: str, found: LegMotion) -> Finding:
    """Of the pose while the legs are linear in time."""
    off = 1e3 * float(found.position_deviation.max())
    turn = float(np.degrees(found.angle_deviation.max()))
    return Finding(
        f'linear_{kind}', LINEAR, f'{kind}: linear legs, position off linear (fig. '
        f'{FIGURES[kind][0]})', Claim('linear', (0.0,), LINEAR_MM, NEARLY_MM),
        f'≤ {off:.3f} mm and {turn:.4f}°', (off,), 'mm', 1e-3,
        'nearly; the paper’s figure cannot show it. Its angles φ are lost in the scan, ours are '
        'in the machine file',
    )  # fmt: skip


def angles(kind: str, found: LegMotion) -> Finding:
    """The ZXZ angles, continuous from the start as the paper solves for them."""
    degrees = np.degrees(found.euler_zxz)
    spans = ', '.join(
        f'{name} {minus(f"{low:.3f} … {high:.3f}")}°'
        for name, low, high in zip('αβγ', degrees.min(axis=0), degrees.max(axis=0), strict=True)
    )
    largest = float(np.abs(degrees).max())
    return Finding(
        f'angles_{kind}', LINEAR, f'{kind}: Euler angles ZXZ (fig. {FIGURES[kind][1]})',
        Claim('smooth curves within ±1', (SHOWN_DEGREES,), side='at most'), spans, (largest,), '°',
        1e-3, 'continuous from the last sample, β of either sign; with β ≥ 0 they would jump by '
        '180°. Here β is the tilt about x, and α + γ is 0 within 0.002°',
    )  # fmt: skip


def plane_method() -> Finding:
    """The paper's nine equations against six, along the whole experiment."""
    worst = 0.0
    for name in MACHINES.values():
        plates = build(PlatesConfig, machines.read(name).geometry)
        plane, kinematics = PlaneMethod.of(plates), platform(name)
        there = paper_motion(kinematics.geometry, lambda q, near: plane.solve(q, near).pose)  # noqa: B023
        gap = there.poses.twist_to(motion(name).poses)
        worst = max(worst, 1e6 * float(np.abs(gap).max()))
    return Finding(
        'plane_method', LINEAR, 'forward kinematics by the plane of three points, against ours',
        Claim('works', (0.0,), 1e-3), f'differs by {worst:.0e} µm or µrad at most', (worst,),
        'µm', 1e-3, 'nine unknowns instead of six, the same pose at all 101 steps',
    )  # fmt: skip


def solutions() -> Finding:
    """Real poses for one set of leg lengths."""
    kinematics = platform('stewart_6_6')
    modes = modes_of(kinematics, kinematics.inverse(kinematics.home))
    return Finding(
        'solutions', LINEAR, 'solutions of the forward problem',
        Claim('up to 40; the nearest is taken', (40.0,), side='at most'),
        f'{modes.complex_count} in all, {len(modes.poses)} real at home',
        (float(len(modes.poses)),), 'real poses', 0.5,
        'all computed at once: [forward-modes.md](forward-modes.md)',
    )  # fmt: skip


def multi_section(count: int, alone: Array) -> Finding:
    """The outlook: 6-6 platforms on each other, and what their end gains by one of them."""
    path = machines.find('stack_6_6')
    content = machines.content_of(path)
    section = content['geometry']['sections'][0]
    content['geometry'] = {'sections': [section] * count}
    machine = machines.loader('stack')(build(MachineFile, content))
    gains = _spans(machine) / alone
    words = ', '.join(f'{axis} {gain:.2f}' for axis, gain in zip(GAIN_AXES, gains, strict=True))
    return Finding(
        f'sections_{count}', LINEAR, f'outlook: {count} sections 6-6 on each other, ranges by '
        'those of one', unstated('proposed (LX-4 has four)'), words, tuple(map(float, gains)), '',
        0.01, f'{6 * count} joints for one pose: each section stays nearest to its home '
        '([kinematics.md](kinematics.md), 9); the plates between them are 4 mm, ours',
    )  # fmt: skip


def _spans(machine: Machine) -> Array:
    """How far home moves in all along and about some axes, metres and radians."""
    found = ranges(machine)
    return np.array([np.ptp(found[axis]) for axis in GAIN_AXES])


def platform(name: str) -> LinearPlatform:
    """A shipped linear platform; InvalidInput for another machine."""
    kinematics = machines.load(name).kinematics
    if not isinstance(kinematics, LinearPlatform):
        raise InvalidInput(f'{name} is no linear platform')
    return kinematics
