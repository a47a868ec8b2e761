"""The arm's half of the demonstration's picture: where it stood, and what it held."""

import numpy as np
from matplotlib.axes import Axes
from mpl_toolkits.mplot3d import Axes3D

from hexarm.demo.arm_report import ArmResult
from manipulator.machine import Machine

COLOURS = {'override': '#d4a017', 'square': '#0b6e99', 'look': '#6a994e'}
NAMES = {
    'override': 'stick overrides a goal',
    'square': 'square, orientation held',
    'look': 'to and fro, looking at a point',
}
LINK, POINT = '#9aa5b1', '#d1603d'
POSTURES = {'square': (0.5,), 'look': (0.25, 0.75)}
"""Parts of each phase at which the arm is drawn."""


def draw_arm(axes: Axes3D, result: ArmResult, machine: Machine) -> None:
    """The tool's path by what the stick did, with the arm at some of its postures."""
    seen = result.observation
    for name, parts in POSTURES.items():
        inside = np.flatnonzero(seen.during(name))
        for part in parts:
            _posture(axes, result, machine, int(inside[int(part * len(inside))]), name)
    for name, colour in COLOURS.items():
        path = 1e3 * result.poses.position[seen.during(name)]
        axes.plot(*path.T, color=colour, lw=2.0, label=NAMES[name])
    axes.plot(*(1e3 * seen.point), 'o', color=POINT, ms=6, label='the point')
    axes.set(xlabel='x (mm)', ylabel='y (mm)', zlabel='z (mm)')
    axes.set_aspect('equal', adjustable='box')
    axes.set_box_aspect(None, zoom=0.9)
    axes.view_init(elev=18, azim=-40)
    axes.legend(loc='upper left', frameon=False)


def draw_held(axes: Axes, result: ArmResult) -> None:
    """What the jog modes keep, over time."""
    t = result.observation.times - result.observation.times[0]
    axes.plot(t, 1e3 * result.missed, color=COLOURS['look'], lw=1.1)
    axes.set(xlabel='time (s)', xlim=(0, t[-1]), ylim=(0, None))
    axes.set_ylabel('point missed by (mm)', color=COLOURS['look'])
    axes.grid(alpha=0.25)
    other = axes.twinx()
    other.plot(t, np.degrees(result.turned), color=COLOURS['square'], lw=1.1)
    other.set_ylabel('orientation error (°)', color=COLOURS['square'])
    other.set_ylim(0, None)


def _posture(axes: Axes3D, result: ArmResult, machine: Machine, k: int, name: str) -> None:
    for stroke in machine.kinematics.skeleton(result.poses[k], result.observation.joints[k]):
        axes.plot(*(1e3 * stroke.points).T, color=LINK, lw=2.5, marker='o', ms=3)
    if name == 'look':
        sight = np.stack([result.poses.position[k], result.observation.point])
        axes.plot(*(1e3 * sight).T, color=POINT, lw=0.8, ls=':')
