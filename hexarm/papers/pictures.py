"""The figures of the report: what each shows, and how all of them are drawn."""

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import matplotlib as mpl

mpl.use('Agg')

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes

from hexarm.papers import arm_method, arm_modes, crank_pictures, linear_platforms, plates
from hexarm.papers.finding import Missing
from hexarm.pictures.style import AXES as COLOURS

if TYPE_CHECKING:
    from hexarm.simulation.experiment import Recording

DPI = 90
FIGURES = 'figures'
NAMES = {
    **crank_pictures.CAPTIONS,
    'leg-motion.png': 'Leg lengths linear in time: position, ZXZ angles of the 6-3 (figs 6 and 7) '
    'and of the 6-6 (figs 8 and 9 of Lapikov et al. 2014); dotted: linear motion',
    'equal-angles.png': 'The same motion with φb = φmp: by how much the best pose misses the leg '
    'lengths; positions that the platform takes with the legs of the target, over its tilt',
    'orientation.png': 'Orientation held by three projections (Fadeev and Loginov) and by the '
    'angular velocity in closed loop, as the nodes do',
}


def draw(folder: Path, recording: 'Recording | None') -> Iterator[str | Missing]:
    """Saves the figures in an existing folder; their names, or why one is missing."""
    plt.rcParams.update({'font.size': 9, 'axes.spines.top': False, 'axes.spines.right': False})
    for name in NAMES:
        try:
            if name in PLAIN:
                PLAIN[name](folder / name)
            elif recording is not None:
                crank_pictures.sensors(recording, folder / name)
            else:
                yield Missing(FIGURES, name, 'the moving model is missing')
                continue
        except ModuleNotFoundError as error:
            yield Missing(FIGURES, name, f'{error.name} is not installed')
            continue
        yield name


def leg_motion(path: Path) -> None:
    """Figs 6 to 9, as absolute curves."""
    figure, axes = plt.subplots(2, 2, figsize=(9, 6), dpi=DPI, sharex=True, layout='constrained')
    for column, (kind, name) in enumerate(linear_platforms.MACHINES.items()):
        found = linear_platforms.motion(name)
        figures = linear_platforms.FIGURES[kind]
        position, degrees = 1e3 * found.poses.position, np.degrees(found.euler_zxz)
        upper: Axes = axes[0, column]
        lower: Axes = axes[1, column]
        for k, colour in enumerate(COLOURS):
            dashes = (0, (4, 4)) if k == 1 else '-'  # y lies on x
            upper.plot(found.share, position[:, k], color=colour, ls=dashes, label='xyz'[k])
            lower.plot(found.share, degrees[:, k], color=colour, label='αβγ'[k])
        upper.plot(found.share, 1e3 * found.straight.position, color='#4a5a6a', lw=0.8, ls=':')
        upper.set_title(f'{kind}, fig. {figures[0]}: position (mm)', size=10)
        lower.set_title(f'{kind}, fig. {figures[1]}: ZXZ angles (°)', size=10)
        lower.set(xlabel='part of the way', xlim=(0, 1), ylim=(-0.4, 0.4))
        for each in (upper, lower):
            each.grid(alpha=0.25)
            each.legend(frameon=False)
    figure.savefig(path)
    plt.close(figure)


def equal_angles(path: Path) -> None:
    """What φb = φmp does: no solution on the way, and many at its end."""
    figure, axes = plt.subplots(1, 2, figsize=(9, 3.4), dpi=DPI, layout='constrained')
    for degrees, colour in zip(plates.EQUAL_DEGREES, COLOURS, strict=True):
        motion = plates.Plates(degrees, degrees).motion()
        misfits = [1e6 * solution.residual for solution in motion]
        label = f'φb = φmp = {degrees:g}°'
        axes[0].plot(np.linspace(0, 1, len(misfits)), misfits, color=colour, lw=1.3, label=label)
    shape = plates.Plates(plates.EQUAL_DEGREES[1], plates.EQUAL_DEGREES[1])
    tilts = np.radians(np.linspace(0.0, 10.0, 11))
    places = 1e3 * np.array([plates.same_legs(shape, tilt).position for tilt in tilts])
    for k, colour in enumerate(COLOURS):
        label = f'{"xyz"[k]} − {places[0, k]:.0f} mm'
        axes[1].plot(np.degrees(tilts), places[:, k] - places[0, k], color=colour, label=label)
    axes[0].set(xlabel='part of the way', ylabel='leg length missed (µm)', xlim=(0, 1))
    axes[1].set(xlabel='tilt (°), all legs as at the target', ylabel='position (mm)', xlim=(0, 10))
    for each in axes:
        each.grid(alpha=0.25)
        each.legend(frameon=False)
    figure.savefig(path)
    plt.close(figure)


def orientation(path: Path) -> None:
    """The drift of the paper's method, and the error of ours."""
    figure, axes = plt.subplots(figsize=(6, 3.2), dpi=DPI, layout='constrained')
    series = {
        'a_x′ = a_z′ = n_z′ = 0, steps of 10 ms': arm_method.followed(is_measured=True).turned,
        'angular velocity, closed loop': arm_modes.held_orientation()[1:],
    }
    for (label, degrees), colour in zip(series.items(), COLOURS, strict=False):
        times = arm_method.TICK * np.arange(1, len(degrees) + 1)
        axes.semilogy(times, degrees, color=colour, lw=1.3, label=label)
    axes.set(xlabel='time (s)', ylabel='tool turned by (°)', xlim=(0, arm_method.SECONDS))
    axes.grid(alpha=0.25)
    axes.legend(frameon=False)
    figure.savefig(path)
    plt.close(figure)


PLAIN: dict[str, Callable[[Path], None]] = {
    **crank_pictures.PLAIN,
    'leg-motion.png': leg_motion,
    'equal-angles.png': equal_angles,
    'orientation.png': orientation,
}
