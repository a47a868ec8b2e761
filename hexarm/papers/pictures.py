"""The figures of the report."""

from pathlib import Path

import matplotlib as mpl

mpl.use('Agg')

import matplotlib.pyplot as plt
import numpy as np

from hexarm import machines
from hexarm.cli.export import modelled
from hexarm.demo.picture import CRANKS
from hexarm.papers import linear_platforms
from hexarm.papers.crank_kinematics import MACHINE, crank_speeds
from hexarm.pictures.leg_motion import COLOURS
from hexarm.pictures.simulation import draw as draw_sensors
from hexarm.simulation.experiment import Recording

DPI = 90
NAMES = {
    'fig-9.png': 'Crank speeds while the platform moves along x at 30 mm/s (Prokopovich 2019, '
    'fig. 9): unbounded at the ends of the range',
    'fig-13.png': 'Sinusoids of fig. 12 in phase, with 150 g: torques and speeds of the cranks '
    '(Prokopovich 2019, fig. 13), speed and acceleration of the platform',
    'leg-motion.png': 'Leg lengths linear in time (Lapikov et al. 2014, section 4): deviation '
    'of the poses of the 6-3 and the 6-6 from a linear motion',
}


def draw(folder: Path, recording: Recording) -> None:
    """Saves all figures in an existing folder."""
    plt.rcParams.update({'font.size': 9, 'axes.spines.top': False, 'axes.spines.right': False})
    _crank_speeds(folder / 'fig-9.png')
    draw_sensors(recording, modelled(MACHINE), folder / 'fig-13.png', DPI)
    _leg_motion(folder / 'leg-motion.png')


def _crank_speeds(path: Path) -> None:
    places = np.linspace(-0.0155, 0.0155, 621)
    speeds = crank_speeds(machines.load(MACHINE), places)
    figure, axes = plt.subplots(figsize=(8, 3.6), dpi=DPI, layout='constrained')
    for k, colour in enumerate(CRANKS):
        axes.plot(1e3 * places, speeds[:, k], color=colour, lw=1.3, label=f'crank {k + 1}')
    axes.set(xlabel='x from home (mm)', ylabel='crank speed (°/s)', xlim=(-15.5, 15.5))
    axes.set_ylim(-400, 400)
    axes.grid(alpha=0.25)
    axes.legend(frameon=False, loc='center left', bbox_to_anchor=(1.0, 0.5))
    figure.savefig(path)
    plt.close(figure)


def _leg_motion(path: Path) -> None:
    figure, axes = plt.subplots(1, 2, figsize=(9, 3.4), dpi=DPI, layout='constrained')
    for (kind, name), style in zip(linear_platforms.MACHINES.items(), ('-', '--'), strict=True):
        found = linear_platforms.motion(name)
        off = found.straight.twist_to(found.poses)
        for k, colour in enumerate(COLOURS):
            axis = 'xyz'[k]
            axes[0].plot(
                found.share, 1e3 * off[:, k], style, color=colour, label=f'{axis}, {kind}'
            )
            axes[1].plot(found.share, np.degrees(off[:, 3 + k]), style, color=colour)
    axes[0].set(xlabel='part of the way', ylabel='position off linear (mm)', xlim=(0, 1))
    axes[1].set(xlabel='part of the way', ylabel='rotation vector off linear (°)', xlim=(0, 1))
    for each in axes:
        each.grid(alpha=0.25)
    figure.legend(frameon=False, ncols=6, loc='outside upper center')
    figure.savefig(path)
    plt.close(figure)
