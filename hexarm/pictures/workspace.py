"""The pictures of a workspace: its shape with sections, and joint speeds along an axis."""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import QuadMesh
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from mpl_toolkits.mplot3d import Axes3D

from hexarm.pictures import style
from manipulator.analysis.free_paths import is_by_joints
from manipulator.analysis.inside import AXES, Section, joint_rates, section, surface
from manipulator.analysis.survey import SEED, Survey
from manipulator.analysis.volume import Box, Volume, bounding_box, volume, with_orientation
from manipulator.arrays import Array
from manipulator.kinematics import BRANCH_JUMP
from manipulator.machine import Machine

GRIDS = {True: 161, False: 61}
RINGS = {True: 37, False: 19}
"""By whether the inverse is explicit; others take up to a millisecond a pose."""
SPEED = 0.03
EVEN = 1e-6
"""Of a value: what is no difference."""
PLANES = ((0, 1), (0, 2), (1, 2))
SHAPE, SPEEDS = 'workspace', 'joint_speeds'


def draw(machine: Machine, found: Survey, path: Path, name: str) -> list[Path]:
    """Saves both pictures: under these names in a folder, or as FILE and beside it."""
    style.use()
    if path.suffix:
        files = [path, path.with_name(f'{path.stem}_{SPEEDS}{path.suffix}')]
    else:
        files = [path / f'{SHAPE}.png', path / f'{SPEEDS}.png']
    files[0].parent.mkdir(parents=True, exist_ok=True)
    shape = _shape(machine, found.box, found.constant_orientation, name)
    return [style.save(shape, files[0]), style.save(_speeds(machine, found, name), files[1])]


def draw_quickly(machine: Machine, picture: Path, name: str, points: int) -> Path:
    """Saves the shape alone, its volume from so few positions: within some seconds."""
    style.use()
    home, length = machine.kinematics.home, machine.kinematics.characteristic_length
    reached = with_orientation(machine, home.rotation)
    box = bounding_box(reached, home.position, length, points)
    found = volume(reached, box, points, np.random.default_rng(SEED))
    return style.save(_shape(machine, box, found, name), picture)


def _shape(machine: Machine, box: Box, found: Volume, name: str) -> Figure:
    """The surface, and three planes through home by σmin and by joint speed."""
    figure: Figure = plt.figure(figsize=(12.6, 6.6), dpi=100)
    what = 'tool' if is_by_joints(machine) else 'platform'
    style.title(
        figure,
        f'{name}: where the {what} goes without turning',
        f'{1e3 * found.value:.4g} ± {float(f"{1e3 * found.error:.1g}"):g} dm³ within all limits; '
        'sections through home, which is marked +',
    )
    _surface(figure.add_axes((-0.025, 0.02, 0.37, 0.88), projection='3d'), machine)
    grid = GRIDS[machine.kinematics.is_explicit]
    planes = [section(machine, axes, box.low, box.high, grid) for axes in PLANES]
    rows = (
        ('sigma_min', 'singularity margin σmin', style.MAP, 1.0),
        ('joint_speed', _speed_label(machine), style.RATE_MAP, _speed_factor(machine)),
    )
    for row, (field, label, colours, factor) in enumerate(rows):
        values = [factor * getattr(plane.conditions, field) for plane in planes]
        inside = np.concatenate([v[np.isfinite(v)] for v in values])
        limits = _colour_limits(inside)
        for column, (plane, value) in enumerate(zip(planes, values, strict=True)):
            place = (0.385 + 0.19 * column, 0.535 - 0.445 * row, 0.14, 0.32)
            drawn = draw_section(figure.add_axes(place), plane, value, (colours, *limits), machine)
        bar = figure.add_axes((0.945, 0.55 - 0.445 * row, 0.01, 0.28))
        figure.colorbar(drawn, cax=bar)
        figure.text(0.385, 0.875 - 0.445 * row, label, color=style.SOFT)
    return figure


def _colour_limits(values: Array) -> tuple[float, float]:
    """Without the highest values; of a value that is the same everywhere, itself in the middle."""
    low, high = np.quantile(values, [0.0, 0.98]).tolist()
    is_even = high - low <= EVEN * abs(high)
    return (0.0, 2.0 * high) if is_even else (low, high)


def _surface(axes: Axes3D, machine: Machine) -> None:
    rings = RINGS[machine.kinematics.is_explicit]
    polar, turn = np.meshgrid(
        np.linspace(0, np.pi, rings), np.linspace(0, 2 * np.pi, 2 * rings - 1), indexing='ij'
    )
    directions = np.stack(
        [np.sin(polar) * np.cos(turn), np.sin(polar) * np.sin(turn), np.cos(polar)], axis=-1
    )
    x, y, z = np.moveaxis(1e3 * surface(machine, directions), -1, 0)
    axes.plot_surface(
        x, y, z, cmap='YlGnBu_r', rstride=1, cstride=1, lw=0.15, edgecolor='#ffffff90'
    )
    style.space(axes, 0.8)
    axes.view_init(elev=18, azim=-60)


def draw_section(
    axes: Axes, plane: Section, values: Array, scale: tuple[str, float, float], machine: Machine
) -> QuadMesh:
    """One map, with the workspace's edge and home."""
    colours, low, high = scale
    across, up = 1e3 * plane.across, 1e3 * plane.up
    drawn = axes.pcolormesh(
        across, up, values, cmap=colours, vmin=low, vmax=high, shading='nearest', rasterized=True
    )
    axes.contour(
        across, up, plane.conditions.admitted, levels=[0.5], colors=style.INK, linewidths=0.9
    )
    home = 1e3 * machine.kinematics.home.position
    for colour, width in ((style.PAPER, 3.2), (style.INK, 1.2)):
        axes.plot(*home[list(plane.axes)], '+', color=colour, ms=8, mew=width)
    axes.set_xlabel(f'{AXES[plane.axes[0]]} (mm)', labelpad=1)
    axes.set_ylabel(f'{AXES[plane.axes[1]]} (mm)', labelpad=1)
    axes.set_aspect('equal', adjustable='box')
    for side in (axes.xaxis, axes.yaxis):
        side.set_major_locator(MaxNLocator(4))
    return drawn


def _speed_factor(machine: Machine) -> float:
    """From rad/m to degrees per millimetre; m/m stays."""
    return float(np.degrees(1e-3)) if machine.kinematics.joint_unit == 'rad' else 1.0


def _speed_label(machine: Machine) -> str:
    unit = '°/s per mm/s' if machine.kinematics.joint_unit == 'rad' else 'mm/s per mm/s'
    return f'fastest joint per platform speed, worst direction ({unit})'


def _speeds(machine: Machine, found: Survey, name: str) -> Figure:
    """Joint positions and speeds while x moves at 30 mm/s: Prokopovich 2019, fig. 9."""
    low, high = found.ranges['x']
    x = np.linspace(low, high, 803)[1:-1]
    home, kinematics = machine.kinematics.home, machine.kinematics
    poses = home.moved(x[:, None] * np.eye(6)[0])
    factor, unit = (np.degrees(1.0), '°') if kinematics.joint_unit == 'rad' else (1e3, 'mm')
    joints = _with_gaps(kinematics.inverse_or_nan(poses))
    rates = factor * SPEED * joint_rates(machine, poses)[..., 0]
    rates[np.isnan(joints)] = np.nan
    joints *= factor
    figure: Figure = plt.figure(figsize=(style.WIDTH, 4.4), dpi=100)
    left, right = map(style.plotted, figure.subplots(1, 2))
    figure.subplots_adjust(left=0.07, right=0.98, bottom=0.12, top=0.76, wspace=0.2)
    style.title(figure, f'{name}: joints while x moves at 30 mm/s through home')
    for k, joint in enumerate(kinematics.joint_names):
        look = style.curve(k)
        left.plot(1e3 * x, joints[:, k], label=joint, **look)
        right.plot(1e3 * x, rates[:, k], **look)
    left.set(xlabel='x from home (mm)', ylabel=f'joint position ({unit})')
    right.set(xlabel='x from home (mm)', ylabel=f'joint speed ({unit}/s)')
    bound = 1.15 * float(np.nanquantile(np.abs(rates), 0.985))
    right.set_ylim(-bound, bound)
    style.limits(right, float(factor * np.max(machine.motion.joint.speed)), f'{unit}/s')
    figure.legend(
        *left.get_legend_handles_labels(), ncols=6, loc='upper left', bbox_to_anchor=(0.06, 0.9)
    )
    return figure


def _with_gaps(joints: Array) -> Array:
    """Joints (n, joints) with NaN where one comes to another branch: no curve joins the two."""
    jumps = np.abs(np.diff(joints, axis=0)).max(axis=-1) > BRANCH_JUMP
    is_gap = np.append(jumps, False) | np.insert(jumps, 0, False)
    return np.where(is_gap[:, None], np.nan, joints)
