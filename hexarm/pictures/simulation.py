"""What the sensors of a simulation showed: Prokopovich 2019, figs 12 d and 13."""

from pathlib import Path

import matplotlib as mpl

mpl.use('Agg')

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes

from hexarm.demo.picture import CRANKS
from hexarm.simulation.experiment import Recording
from hexarm.simulation.rigid_body import Mechanism, RigidBody
from hexarm.simulation.sensors import AXES, carrying_force
from manipulator.arrays import Array

N_CM = 0.01
LIMIT = '#b3261e'
AXIS_COLOURS = ('#0b6e99', '#d1603d', '#6a994e')


def draw(
    recording: Recording, mechanism: Mechanism, picture: Path, load: RigidBody, dpi: int = 130
) -> None:
    """Saves the picture."""
    plt.rcParams.update({'font.size': 9, 'axes.spines.top': False, 'axes.spines.right': False})
    figure, axes = plt.subplots(3, 2, figsize=(10, 8), dpi=dpi, sharex=True, layout='constrained')
    _drives(axes[0, 0], axes[0, 1], recording, mechanism)
    twists, accelerations = recording.twists, recording.accelerations
    places = 1e3 * (recording.poses.position - recording.commanded.position.mean(axis=0))
    on_axes = {
        axes[1, 0]: ('c) platform, position from the middle (mm)', places),
        axes[1, 1]: ('d) platform, speed (mm/s)', 1e3 * twists[:, :3]),
        axes[2, 0]: ('e) platform, acceleration (m/s²)', accelerations[:, :3]),
        axes[2, 1]: ('f) force that carries the payload (N)', carrying_force(recording, load)),
    }
    for each, (title, values) in on_axes.items():
        for k, (name, colour) in enumerate(zip(AXES, AXIS_COLOURS, strict=True)):
            dashes = (0, (4, 4)) if name == 'y' else '-'  # y often lies on x
            each.plot(recording.times, values[:, k], color=colour, lw=1.1, ls=dashes, label=name)
        each.set_title(title, size=10)
    axes[1, 0].legend(ncols=3, frameon=False, fontsize=8, loc='upper right')
    for each in axes.flat:
        each.grid(alpha=0.25)
        each.set_xlim(0, recording.times[-1])
    for each in axes[2]:
        each.set_xlabel('time (s)')
    figure.savefig(picture)
    plt.close(figure)


def _drives(efforts: Axes, speeds: Axes, recording: Recording, mechanism: Mechanism) -> None:
    """Effort and speed of each joint, with the limits of its drive."""
    drives, is_rotary = mechanism.drives, mechanism.joint_unit == 'rad'
    is_small = is_rotary and float(drives.effort.max()) < 1.0
    factor, unit = (1 / N_CM, 'N·cm') if is_small else (1.0, 'N·m' if is_rotary else 'N')
    _joints(efforts, recording.times, factor * recording.efforts, mechanism.joints)
    efforts.set_title(f'a) effort of each joint ({unit})')
    _limit(efforts, float(factor * drives.effort.min()), unit)
    factor, unit = (np.degrees(1.0), '°/s') if is_rotary else (1e3, 'mm/s')
    _joints(speeds, recording.times, factor * recording.rates, mechanism.joints)
    speeds.set_title(f'b) speed of each joint ({unit})')
    _limit(speeds, float(factor * drives.speed.min()), unit)
    efforts.legend(ncols=3, frameon=False, fontsize=7, loc='upper right')


def _joints(axes: Axes, times: Array, values: Array, names: tuple[str, ...]) -> None:
    for k, (name, colour) in enumerate(zip(names, CRANKS, strict=True)):
        axes.plot(times, values[:, k], color=colour, lw=1.1, label=name)


def _limit(axes: Axes, limit: float, unit: str) -> None:
    """The drives' end in words, and as lines where those are near enough to the curves."""
    axes.set_title(f'{axes.get_title()}, drives: {limit:.3g} {unit}', size=10)
    if limit < 4 * max(abs(v) for v in axes.get_ylim()):
        for sign in (-1, 1):
            axes.axhline(sign * limit, color=LIMIT, lw=0.8, ls='--')
    else:
        axes.margins(y=0.3)
