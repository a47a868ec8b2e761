"""The figures of the report: what each shows, and how all of them are drawn."""

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes

from hexarm.papers import arm_method, arm_modes, crank_pictures, linear_platforms, plates
from hexarm.papers.finding import Missing
from hexarm.pictures import style
from hexarm.pictures.leg_motion import defined

if TYPE_CHECKING:
    from hexarm.simulation.experiment import Recording

DPI = 90
FIGURES = 'figures'
NAMES = {
    **crank_pictures.CAPTIONS,
    'leg-motion.png': 'Leg lengths linear in time: position, ZXZ angles of the 6-3 (figs 6 and 7) '
    'and of the 6-6 (figs 8 and 9 of Lapikov et al. 2014); wide and light: linear motion',
    'equal-angles.png': 'The same motion with φb = φmp: by how much the best pose misses the leg '
    'lengths; positions that the platform takes with the legs of the target, over its tilt',
    'orientation.png': 'Orientation held by three projections (Fadeev and Loginov) and by the '
    'angular velocity in closed loop, as the nodes do',
}


def draw(folder: Path, recording: 'Recording | None') -> Iterator[str | Missing]:
    """Saves the figures in an existing folder; their names, or why one is missing."""
    style.use()
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
        position, degrees = 1e3 * found.poses.position, np.degrees(defined(found.euler_zxz))
        upper: Axes = axes[0, column]
        lower: Axes = axes[1, column]
        for k in range(3):
            upper.plot(found.share, position[:, k], label='xyz'[k], **style.axis(k))
            lower.plot(found.share, degrees[:, k], label='αβγ'[k], **style.axis(k))
        upper.plot(found.share, 1e3 * found.straight.position, color=style.LIGHT, lw=4.0, zorder=1)
        upper.set_title(f'{kind}, fig. {figures[0]}: position (mm)', size=10)
        lower.set_title(f'{kind}, fig. {figures[1]}: ZXZ angles (°)', size=10)
        lower.set(xlabel='part of the way', xlim=(0, 1), ylim=(-0.4, 0.4))
        for each in (upper, lower):
            each.grid(True)
            each.legend()
    style.save(figure, path)


def equal_angles(path: Path) -> None:
    """What φb = φmp does: no solution on the way, and many at its end."""
    figure, axes = plt.subplots(1, 2, figsize=(9, 3.4), dpi=DPI, layout='constrained')
    for degrees, colour in zip(plates.EQUAL_DEGREES, style.AXES, strict=True):
        motion = plates.Plates(degrees, degrees).motion()
        misfits = [1e6 * solution.residual for solution in motion]
        label = f'φb = φmp = {degrees:g}°'
        axes[0].plot(np.linspace(0, 1, len(misfits)), misfits, color=colour, lw=1.3, label=label)
    shape = plates.Plates(plates.EQUAL_DEGREES[1], plates.EQUAL_DEGREES[1])
    tilts = np.radians(np.linspace(0.0, 10.0, 11))
    places = 1e3 * np.array([plates.same_legs(shape, tilt).position for tilt in tilts])
    for k in range(3):
        label = f'{"xyz"[k]} − {places[0, k]:.0f} mm'
        axes[1].plot(np.degrees(tilts), places[:, k] - places[0, k], label=label, **style.axis(k))
    axes[0].set(xlabel='part of the way', ylabel='leg length missed (µm)', xlim=(0, 1))
    axes[1].set(xlabel='tilt (°), all legs as at the target', ylabel='position (mm)', xlim=(0, 10))
    for each in axes:
        each.grid(True)
        each.legend()
    style.save(figure, path)


def orientation(path: Path) -> None:
    """The drift of the paper's method, and the error of ours."""
    figure, axes = plt.subplots(figsize=(6, 3.2), dpi=DPI, layout='constrained')
    series = {
        'a_x′ = a_z′ = n_z′ = 0, steps of 10 ms': arm_method.followed(is_measured=True).turned,
        'angular velocity, closed loop': arm_modes.held_orientation()[1:],
    }
    for (label, degrees), colour in zip(series.items(), style.AXES, strict=False):
        times = arm_method.TICK * np.arange(1, len(degrees) + 1)
        axes.semilogy(times, degrees, color=colour, lw=1.3, label=label)
    axes.set(xlabel='time (s)', ylabel='tool turned by (°)', xlim=(0, arm_method.SECONDS))
    axes.grid(True)
    axes.legend()
    style.save(figure, path)


PLAIN: dict[str, Callable[[Path], None]] = {
    **crank_pictures.PLAIN,
    'leg-motion.png': leg_motion,
    'equal-angles.png': equal_angles,
    'orientation.png': orientation,
}
