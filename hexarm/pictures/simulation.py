"""What the sensors of a simulation showed, as Prokopovich 2019, fig. 13, and the platform's."""

from pathlib import Path

import matplotlib as mpl

mpl.use('Agg')

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes

from hexarm.demo.picture import CRANKS
from hexarm.simulation.experiment import Recording
from hexarm.simulation.rigid_body import Mechanism
from manipulator.arrays import Array
from manipulator.errors import InvalidInput
from manipulator.formatting import reason

KG_CM = 0.0980665
LIMIT = '#b3261e'


def draw(recording: Recording, mechanism: Mechanism, picture: Path, dpi: int = 130) -> None:
    """Saves the picture; InvalidInput where it cannot be saved under this name."""
    plt.rcParams.update({'font.size': 9, 'axes.spines.top': False, 'axes.spines.right': False})
    figure, axes = plt.subplots(2, 2, figsize=(10, 6), dpi=dpi, sharex=True, layout='constrained')
    drives, is_rotary = mechanism.drives, mechanism.joint_unit == 'rad'
    is_small = is_rotary and float(drives.effort.max()) < 1.0
    factor, unit = (1 / KG_CM, 'kg·cm') if is_small else (1.0, 'N·m' if is_rotary else 'N')
    _joints(axes[0, 0], recording.times, factor * recording.efforts, mechanism.joints)
    axes[0, 0].set(ylabel=f'effort of each joint ({unit})', title='a) effort')
    _limit(axes[0, 0], float(factor * drives.effort.min()), unit)
    factor, unit = (np.degrees(1.0), '°/s') if is_rotary else (1e3, 'mm/s')
    _joints(axes[0, 1], recording.times, factor * recording.rates, mechanism.joints)
    axes[0, 1].set(ylabel=f'speed of each joint ({unit})', title='b) speed')
    _limit(axes[0, 1], float(factor * drives.speed.min()), unit)
    axes[0, 0].legend(ncols=3, frameon=False, fontsize=7, loc='upper right')
    speed = 1e3 * np.linalg.norm(recording.twists[:, :3], axis=1)
    axes[1, 0].plot(recording.times, speed, color=CRANKS[0], lw=1.2)
    axes[1, 0].set(ylabel='platform, speed (mm/s)', xlabel='time (s)', ylim=(0, None))
    acceleration = np.linalg.norm(recording.accelerations[:, :3], axis=1)
    axes[1, 1].plot(recording.times, acceleration, color=CRANKS[0], lw=1.2)
    axes[1, 1].set(ylabel='platform, acceleration (m/s²)', xlabel='time (s)', ylim=(0, None))
    for each in axes.flat:
        each.grid(alpha=0.25)
        each.set_xlim(0, recording.times[-1])
    try:
        figure.savefig(picture)
    except (OSError, ValueError) as error:
        raise InvalidInput(f'cannot save {picture}: {reason(error)}') from error
    finally:
        plt.close(figure)


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
