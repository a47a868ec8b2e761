"""What the sensors of a simulation showed: Prokopovich 2019, figs 12 d and 13."""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes

from hexarm.pictures import style
from hexarm.simulation.experiment import Recording
from hexarm.simulation.rigid_body import Mechanism, RigidBody
from hexarm.simulation.sensors import AXES, carrying_force
from manipulator.arrays import Array

N_CM = 0.01


def draw(
    recording: Recording,
    mechanism: Mechanism,
    picture: Path,
    load: RigidBody,
    name: str = '',
    dpi: int = 110,
) -> None:
    """Saves the picture; name: of the machine, for a title."""
    style.use()
    figure, axes = plt.subplots(
        3, 2, figsize=(style.WIDTH, 8.6), dpi=dpi, sharex=True, layout='constrained'
    )
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
        for k, axis in enumerate(AXES):
            each.plot(recording.times, values[:, k], label=axis, **style.axis(k))
        each.set_title(title, loc='left')
    for each in axes.flat:
        style.plotted(each).set_xlim(0, recording.times[-1])
    for each in axes[2]:
        each.set_xlabel('time (s)')
    if name:
        figure.suptitle(f'{name}: simulated sensors', x=0.01, ha='left', weight='bold')
    figure.legend(*axes[0, 0].get_legend_handles_labels(), ncols=6, loc='outside lower left')
    figure.legend(*axes[1, 0].get_legend_handles_labels(), ncols=3, loc='outside lower right')
    style.save(figure, picture)


def _drives(efforts: Axes, speeds: Axes, recording: Recording, mechanism: Mechanism) -> None:
    """Effort and speed of each joint, with the limits of its drive."""
    drives, is_rotary = mechanism.drives, mechanism.joint_unit == 'rad'
    is_small = is_rotary and float(drives.effort.max()) < 1.0
    factor, unit = (1 / N_CM, 'N·cm') if is_small else (1.0, 'N·m' if is_rotary else 'N')
    _joints(efforts, recording.times, factor * recording.efforts, mechanism.joints)
    efforts.set_title(f'a) effort of each joint ({unit})', loc='left')
    style.limits(efforts, float(factor * drives.effort.min()), unit)
    factor, unit = (np.degrees(1.0), '°/s') if is_rotary else (1e3, 'mm/s')
    _joints(speeds, recording.times, factor * recording.rates, mechanism.joints)
    speeds.set_title(f'b) speed of each joint ({unit})', loc='left')
    style.limits(speeds, float(factor * drives.speed.min()), unit)


def _joints(axes: Axes, times: Array, values: Array, names: tuple[str, ...]) -> None:
    for k, name in enumerate(names):
        axes.plot(times, values[:, k], label=name, **style.curve(k))
