"""The picture of the demonstration: for both machines path, joint angles, errors over time."""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from mpl_toolkits.mplot3d import Axes3D

from hexarm.demo.arm_report import ArmResult
from hexarm.demo.report import Result
from hexarm.pictures import style
from manipulator.arrays import Array
from manipulator.machine import Machine

COLOURS = dict(zip(('square', 'override', 'look'), style.AXES, strict=True))
DASHES = dict(zip(COLOURS, style.DASHES, strict=True))
NAMES = {
    'override': 'stick overrides a goal',
    'square': 'square, orientation held',
    'look': 'to and fro, looking at a point',
}
COMMANDED, DONE, LINK, POINT = style.LIGHT, style.AXES[0], style.LIGHT, style.LIMIT
OTHER = style.AXES[1]
"""Of the curve by the axis on the right."""
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
        axes.plot(*path.T, color=colour, ls=DASHES[name], lw=2.0, label=NAMES[name])
    axes.plot(*(1e3 * seen.point), 'o', color=POINT, ms=6, label='the point')
    style.space(axes)
    axes.view_init(elev=18, azim=-40)
    axes.legend(loc='upper left', frameon=False)


def draw_held(axes: Axes, result: ArmResult) -> None:
    """What the jog modes keep, over time."""
    t = result.observation.times - result.observation.times[0]
    axes.plot(t, 1e3 * result.missed, color=COLOURS['look'], lw=1.1)
    axes.set(xlabel='time (s)', xlim=(0, t[-1]), ylim=(0, None))
    axes.set_ylabel('point missed by (mm)', color=COLOURS['look'])
    axes.grid(True)
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


def draw(result: Result, arm_result: ArmResult, arm: Machine, picture: Path) -> None:
    """Saves the picture."""
    style.use()
    figure = plt.figure(figsize=(12, 12.8), dpi=110)
    _path(figure.add_axes((0.01, 0.51, 0.46, 0.43), projection='3d'), result)
    _joints(figure.add_axes((0.56, 0.775, 0.37, 0.155)), 'crank of leg', *_angles(result))
    _errors(figure.add_axes((0.56, 0.545, 0.37, 0.165)), result)
    draw_arm(figure.add_axes((0.01, 0.01, 0.46, 0.43), projection='3d'), arm_result, arm)
    _joints(figure.add_axes((0.56, 0.275, 0.37, 0.155)), 'joint', *_angles(arm_result))
    draw_held(figure.add_axes((0.56, 0.045, 0.37, 0.165)), arm_result)
    for y, title, source in (
        (0.975, 'RoboCake: goal moves and a tilted circle', "the fake board's servos"),
        (0.475, 'Six-axis arm: driven by a gamepad through joy_teleop', 'its stepper drives'),
    ):
        figure.text(0.02, y, title, size=14, weight='bold')
        figure.text(0.02, y - 0.0175, f'from the true joint angles of {source}', color=style.SOFT)
    style.save(figure, picture)


def _angles(result: Result | ArmResult) -> tuple[Array, Array]:
    seen = result.observation
    return seen.times - seen.times[0], np.degrees(seen.joints)


def _path(axes: Axes3D, result: Result) -> None:
    curve = result.observation.curve
    commanded = [curve.pose_at(t).position for t in np.linspace(0, curve.duration, 400)]
    corners = [result.poses.position[0], *(g.position for _, g in result.observation.corners)]
    for points in (commanded, corners):
        axes.plot(*(1e3 * np.array(points).T), color=COMMANDED, lw=5, solid_capstyle='round')
    done = 1e3 * result.poses.position
    axes.plot(*done.T, color=DONE, lw=1.2)
    axes.plot([], [], color=COMMANDED, lw=5, label='commanded')
    axes.plot([], [], color=DONE, lw=1.2, label='done')
    axes.plot(*done[0], 'o', color=OTHER, ms=6, label='park')
    style.space(axes, 0.95)
    axes.view_init(elev=28, azim=-55)
    axes.legend(loc='upper left', frameon=False)


def _joints(axes: Axes, title: str, t: Array, angles: Array) -> None:
    for k in range(angles.shape[1]):
        axes.plot(t, angles[:, k], label=f'{k + 1}', **style.curve(k))
    axes.set(ylabel='angle (°)', xlim=(0, t[-1]))
    axes.legend(title=title, ncols=6, frameon=False, loc='lower left', bbox_to_anchor=(0, 1.0))
    axes.grid(True)


def _errors(axes: Axes, result: Result) -> None:
    t = result.observation.times - result.observation.times[0]
    axes.plot(t, 1e3 * result.contour, color=DONE, lw=1.1)
    axes.set(xlabel='time (s)', xlim=(0, t[-1]), ylim=(0, None))
    axes.set_ylabel('contour error (mm)', color=DONE)
    axes.grid(True)
    other = axes.twinx()
    other.plot(t, np.degrees(result.orientation), color=OTHER, lw=1.1)
    other.set_ylabel('orientation error (°)', color=OTHER)
    other.set_ylim(0, None)
