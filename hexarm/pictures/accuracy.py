"""A map of the position error that servos cause, in three planes through home."""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.figure import Figure

from hexarm.pictures import style
from hexarm.pictures.workspace import PLANES, draw_section
from manipulator.analysis.accuracy import JointErrors, linear_spread
from manipulator.analysis.inside import Section, section
from manipulator.analysis.volume import bounding_box, with_orientation
from manipulator.arrays import Array
from manipulator.machine import Machine
from manipulator.pose import Pose

GRID = 141


def draw(machine: Machine, errors: JointErrors, picture: Path, name: str) -> None:
    """Saves the picture."""
    style.use()
    home, length = machine.kinematics.home, machine.kinematics.characteristic_length
    box = bounding_box(with_orientation(machine, home.rotation), home.position, length)
    planes = [section(machine, axes, box.low, box.high, GRID) for axes in PLANES]
    values = [1e3 * _position_rms(machine, plane, errors) for plane in planes]
    limits = np.quantile(np.concatenate([v[np.isfinite(v)] for v in values]), [0.0, 0.98])
    figure: Figure = plt.figure(figsize=(style.WIDTH, 4.2), dpi=100)
    style.title(
        figure, f'{name}: position error by all servo errors',
        'rms in mm, to first order; unturned, planes through home',
    )  # fmt: skip
    for column, (plane, value) in enumerate(zip(planes, values, strict=True)):
        axes = figure.add_axes((0.06 + 0.3 * column, 0.11, 0.24, 0.68))
        drawn = draw_section(axes, plane, value, (f'{style.MAP}_r', *limits), machine)
    figure.colorbar(drawn, cax=figure.add_axes((0.94, 0.15, 0.012, 0.6)))
    picture.parent.mkdir(parents=True, exist_ok=True)
    style.save(figure, picture)


def _position_rms(machine: Machine, plane: Section, errors: JointErrors) -> Array:
    """Metres, NaN outside the workspace, on the section's grid."""
    inside = plane.conditions.admitted
    home = machine.kinematics.home
    places = np.tile(home.position, (*inside.shape, 1))
    places[..., plane.axes[0]], places[..., plane.axes[1]] = plane.across[None], plane.up[:, None]
    chosen = places[inside]
    poses = Pose(chosen, np.broadcast_to(home.rotation, (len(chosen), 3, 3)))
    values = np.full(inside.shape, np.nan)
    values[inside] = linear_spread(machine.kinematics, poses, errors).position_rms
    return values
