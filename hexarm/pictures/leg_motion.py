"""Plots of a leg motion, as the figures of Lapikov et al. 2014, section 4."""

from pathlib import Path

import matplotlib as mpl

mpl.use('Agg')

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes

from hexapod_control.leg_motion import LegMotion
from manipulator.arrays import Array

COLOURS = ('#0b6e99', '#d1603d', '#6a994e')


def draw(motion: LegMotion, machine: str, picture: Path) -> None:
    """Saves the picture."""
    plt.rcParams.update({'font.size': 9, 'axes.spines.top': False, 'axes.spines.right': False})
    figure, axes = plt.subplots(3, 1, figsize=(8, 9), dpi=130, sharex=True, layout='constrained')
    straight = 1e3 * motion.straight.position
    _curves(axes[0], motion.share, 1e3 * motion.poses.position, ('x', 'y', 'z'))
    lines = axes[0].plot(motion.share, straight, color='#4a5a6a', lw=0.8, ls=':')
    lines[0].set_label('linear')
    _name(axes[0])
    axes[0].set(ylabel='position (mm)', title=f'{machine}: leg lengths linear in time')
    _curves(axes[1], motion.share, np.degrees(motion.euler_zxz), ('α', 'β', 'γ'))
    axes[1].set(ylabel='ZXZ Euler angles (°)')
    _curves(axes[2], motion.share, np.degrees(motion.rotation_vectors), ('rx', 'ry', 'rz'))
    axes[2].set(ylabel='rotation vector (°)', xlabel='part of the way', xlim=(0, 1))
    figure.savefig(picture)
    plt.close(figure)


def _curves(axes: Axes, share: Array, values: Array, names: tuple[str, str, str]) -> None:
    for column, (name, colour) in enumerate(zip(names, COLOURS, strict=True)):
        axes.plot(share, values[:, column], color=colour, lw=1.3, label=name)
    axes.grid(alpha=0.25)
    _name(axes)


def _name(axes: Axes) -> None:
    axes.legend(frameon=False, loc='center left', bbox_to_anchor=(1.0, 0.5))
