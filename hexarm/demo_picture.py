"""The picture of the demonstration: the path, the six crank angles, the error over time."""

from pathlib import Path

import matplotlib as mpl

mpl.use('Agg')

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from mpl_toolkits.mplot3d import Axes3D

from hexarm.demo_report import Result

ASKED, DONE = '#9aa5b1', '#0b6e99'
CRANKS = ('#0b6e99', '#3aa6b9', '#6a994e', '#d4a017', '#d1603d', '#8e4162')


def draw(result: Result, picture: Path) -> None:
    """Saves the picture."""
    plt.rcParams.update({'font.size': 9, 'axes.spines.top': False, 'axes.spines.right': False})
    figure = plt.figure(figsize=(12, 6.4), dpi=130)
    _path(figure.add_axes((-0.02, 0.02, 0.5, 0.88), projection='3d'), result)
    _cranks(figure.add_axes((0.53, 0.55, 0.4, 0.31)), result)
    _errors(figure.add_axes((0.53, 0.09, 0.4, 0.33)), result)
    figure.text(0.02, 0.95, 'RoboCake: goal moves and a tilted circle', size=14, weight='bold')
    figure.text(
        0.02, 0.915, "from the true crank angles of the fake board's servos", color='#4a5a6a'
    )
    figure.savefig(picture)
    plt.close(figure)


def _path(axes: Axes3D, result: Result) -> None:
    curve = result.observation.curve
    asked = [curve.pose_at(t).position for t in np.linspace(0, curve.duration, 400)]
    corners = [result.poses.position[0], *(g.position for _, g in result.observation.corners)]
    for points in (asked, corners):
        axes.plot(*(1e3 * np.array(points).T), color=ASKED, lw=5, solid_capstyle='round')
    done = 1e3 * result.poses.position
    axes.plot(*done.T, color=DONE, lw=1.2)
    axes.plot([], [], color=ASKED, lw=5, label='asked for')
    axes.plot([], [], color=DONE, lw=1.2, label='done')
    axes.plot(*done[0], 'o', color='#d1603d', ms=6, label='park')
    axes.set(
        xlabel='x (mm)',
        ylabel='y (mm)',
        zlabel='z (mm)',
    )
    axes.set_aspect('equal', adjustable='box')
    axes.set_box_aspect(None, zoom=1.0)
    axes.view_init(elev=28, azim=-55)
    axes.legend(loc='upper left', frameon=False)


def _cranks(axes: Axes, result: Result) -> None:
    t = result.observation.times - result.observation.times[0]
    for k, colour in enumerate(CRANKS):
        angles = np.degrees(result.observation.joints[:, k])
        axes.plot(t, angles, color=colour, lw=1.1, label=f'{k + 1}')
    axes.set(ylabel='crank angle (°)', xlim=(0, t[-1]))
    axes.legend(
        title='crank of leg', ncols=6, frameon=False, loc='lower left', bbox_to_anchor=(0, 1.0)
    )
    axes.grid(alpha=0.25)


def _errors(axes: Axes, result: Result) -> None:
    t = result.observation.times - result.observation.times[0]
    axes.plot(t, 1e3 * result.contour, color=DONE, lw=1.1)
    axes.set(xlabel='time (s)', xlim=(0, t[-1]), ylim=(0, None))
    axes.set_ylabel('contour error (mm)', color=DONE)
    axes.grid(alpha=0.25)
    other = axes.twinx()
    other.plot(t, np.degrees(result.orientation), color='#d1603d', lw=1.1)
    other.set_ylabel('orientation error (°)', color='#d1603d')
    other.set_ylim(0, None)
