"""A simulated motion as an animated GIF, drawn from the model's own shapes."""

from pathlib import Path

import matplotlib as mpl

mpl.use('Agg')

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.animation import FuncAnimation, PillowWriter
from matplotlib.artist import Artist
from mpl_toolkits.mplot3d import Axes3D
from mpl_toolkits.mplot3d.art3d import Line3DCollection, Poly3DCollection

from hexarm.simulation.drawing import ROUND, Shapes, shapes
from hexarm.simulation.experiment import Recording
from hexarm.simulation.simulation import Simulation
from manipulator.arrays import Array
from manipulator.errors import InvalidInput
from manipulator.formatting import reason
from manipulator.kinematics import Kinematics

FRAMES_PER_SECOND = 20
MOST_FRAMES = 200


def animate(
    simulation: Simulation, kinematics: Kinematics, recording: Recording, picture: Path
) -> None:
    """Saves the GIF, in real time; InvalidInput where it cannot be saved under this name."""
    if picture.suffix.lower() != '.gif':
        raise InvalidInput(f'--animation {picture}: the name must end in .gif')
    seconds = float(recording.times[-1])
    count = min(max(round(seconds * FRAMES_PER_SECOND), 2), MOST_FRAMES)
    chosen = np.linspace(0, len(recording.times) - 1, count).astype(int)
    scenes = []
    for k in chosen:
        pose = recording.poses[int(k)]
        simulation.reset(pose, kinematics.inverse(pose, recording.joints[k]))
        scenes.append(shapes(simulation))
    figure = plt.figure(figsize=(5, 4.2), dpi=100)
    axes = figure.add_axes((0, 0, 1, 1), projection='3d')

    bounds = bounds_of(scenes)
    draw_scene(axes, scenes[0], bounds)

    def frame(k: int) -> list[Artist]:
        draw_scene(axes, scenes[k], bounds)
        axes.text2D(0.03, 0.03, f'{recording.times[chosen[k]]:.2f} s', transform=axes.transAxes)
        return []

    try:
        FuncAnimation(figure, frame, frames=count).save(
            picture, PillowWriter(fps=round(count / seconds))
        )
    except (OSError, ValueError) as error:
        raise InvalidInput(f'cannot save {picture}: {reason(error)}') from error
    finally:
        plt.close(figure)


def bounds_of(scenes: list[Shapes]) -> Array:
    """Lowest and highest coordinates (2, 3) of everything drawn, in metres."""
    points = np.concatenate(
        [part.reshape(-1, 3) for scene in scenes for part in (scene.rods, *scene.outlines)]
    )
    return np.stack([points.min(axis=0), points.max(axis=0)])


def draw_scene(axes: Axes3D, scene: Shapes, bounds: Array) -> None:
    """Clears the axes and draws one moment, the space between the bounds (2, 3) filling them."""
    axes.clear()
    axes.set_axis_off()
    lower, upper = scene.outlines[0::2], scene.outlines[1::2]
    for low, high, colour in zip(lower, upper, scene.outline_colours[0::2], strict=True):
        sides = [[low[i - 1], low[i], high[i], high[i - 1]] for i in range(len(low))]
        faces = Poly3DCollection([low, high, *sides], facecolor=(*colour[:3], 0.35))
        faces.set_edgecolor((*(0.6 * colour[:3]), 0.8))
        faces.set_linewidth(0.4 if len(low) < ROUND else 0.0)
        axes.add_collection3d(faces)
    middle, half = bounds.mean(axis=0), np.ptp(bounds, axis=0) / 2
    widths = 140 * scene.radii / half.max()
    axes.add_collection3d(
        Line3DCollection(scene.rods, colors=scene.rod_colours, linewidths=widths, capstyle='round')
    )
    for name, centre, size in zip('xyz', middle, half, strict=True):
        getattr(axes, f'set_{name}lim')(centre - size, centre + size)
    axes.set_box_aspect(half / half.max(), zoom=1.3 if half[2] < half[0] else 1.0)
    axes.view_init(elev=22, azim=-62)
