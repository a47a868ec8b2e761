"""Plots of a leg motion, with what the figures of Lapikov et al. 2014, section 4, show."""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes

from hexapod_control.leg_motion import LegMotion
from hexarm.pictures import style
from manipulator.arrays import Array

UNDEFINED = 1e-7
"""rad of β, below which ZXZ angles α and γ are not defined, only their sum is."""


def draw(motion: LegMotion, machine: str, picture: Path) -> None:
    """Saves the picture: each coordinate by itself, and beside them what is not linear."""
    style.use()
    figure, axes = plt.subplots(
        3, 2, figsize=(style.WIDTH, 8), dpi=110, sharex=True, layout='constrained'
    )
    places, straight = 1e3 * motion.poses.position, 1e3 * motion.straight.position
    for k, (each, name) in enumerate(zip(axes[:, 0], 'xyz', strict=True)):
        style.plotted(each).plot(motion.share, straight[:, k], color=style.LIGHT, lw=4.0)
        each.plot(motion.share, places[:, k], color=style.INK)
        each.set(ylabel=f'{name} (mm)')
    axes[0, 0].set_title('position; wide and light: linear', loc='left')
    _curves(axes[0, 1], motion.share, places - straight, ('x', 'y', 'z'))
    axes[0, 1].set_title('position, off the linear one (mm)', loc='left')
    _curves(axes[1, 1], motion.share, np.degrees(defined(motion.euler_zxz)), ('α', 'β', 'γ'))
    axes[1, 1].set_title('ZXZ Euler angles (°)', loc='left')
    _curves(axes[2, 1], motion.share, np.degrees(motion.rotation_vectors), ('rx', 'ry', 'rz'))
    axes[2, 1].set_title('rotation vector (°)', loc='left')
    for each in axes[2]:
        each.set(xlabel='part of the way', xlim=(0, 1))
    figure.suptitle(f'{machine}: leg lengths linear in time', x=0.01, ha='left', weight='bold')
    style.save(figure, picture)


def defined(euler: Array) -> Array:
    """ZXZ angles (N, 3), α and γ NaN where only their sum means something."""
    angles: Array = euler.copy()
    angles[np.abs(euler[:, 1]) < UNDEFINED, ::2] = np.nan
    return angles


def _curves(axes: Axes, share: Array, values: Array, names: tuple[str, str, str]) -> None:
    for k, name in enumerate(names):
        style.plotted(axes).plot(share, values[:, k], label=name, **style.axis(k))
    axes.legend(ncols=3, loc='lower right', bbox_to_anchor=(1.0, 1.0), borderaxespad=0.0)
