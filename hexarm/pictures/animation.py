"""A simulated motion as an animated GIF: rods as segments, plates and loads as outlines."""

from dataclasses import dataclass
from pathlib import Path

import matplotlib.pyplot as plt
import mujoco
import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from mpl_toolkits.mplot3d import Axes3D
from mpl_toolkits.mplot3d.art3d import Line3DCollection, Poly3DCollection
from PIL import Image

from hexarm.pictures import style
from hexarm.simulation.experiment import Recording
from hexarm.simulation.simulation import Simulation
from manipulator.arrays import Array, frozen
from manipulator.errors import InvalidInput
from manipulator.formatting import reason
from manipulator.kinematics import Kinematics

ROUND = 24


@dataclass(frozen=True, eq=False)
class Shapes:
    """Rods (m, 2, 3) with their radii and colours, closed outlines (k, points, 3) with theirs."""

    rods: Array
    radii: Array
    rod_colours: Array
    outlines: tuple[Array, ...]
    outline_colours: Array


def shapes(simulation: Simulation) -> Shapes:
    """Of the simulation's present state, base frame, metres; colours are r, g, b, a."""
    model, state = simulation.model, simulation.state
    rods, outlines = [], []
    rod_ids, outline_ids = [], []
    for k in range(model.ngeom):
        place, turn = state.geom_xpos[k], state.geom_xmat[k].reshape(3, 3)
        if model.geom_type[k] == mujoco.mjtGeom.mjGEOM_CAPSULE:
            half = model.geom_size[k, 1] * turn[:, 2]
            rods.append([place - half, place + half])
            rod_ids.append(k)
            continue
        for ring in _rings(model, k):
            outlines.append(frozen(place + ring @ turn.T))
            outline_ids.append(k)
    return Shapes(
        frozen(rods),
        frozen(model.geom_size[rod_ids, 0]),
        frozen(model.geom_rgba[rod_ids]),
        tuple(outlines),
        frozen(model.geom_rgba[outline_ids]),
    )


def _rings(model: mujoco.MjModel, geom: int) -> list[Array]:
    """Lower and upper outline in the shape's own frame."""
    if model.geom_type[geom] == mujoco.mjtGeom.mjGEOM_CYLINDER:
        radius, half = model.geom_size[geom, :2]
        angles = np.linspace(0, 2 * np.pi, ROUND, endpoint=False)
        circle = radius * np.stack([np.cos(angles), np.sin(angles)], axis=1)
        return [np.column_stack([circle, np.full(ROUND, z)]) for z in (-half, half)]
    mesh = model.geom_dataid[geom]
    first, count = model.mesh_vertadr[mesh], model.mesh_vertnum[mesh]
    points = np.asarray(model.mesh_vert[first : first + count], dtype=np.float64)
    # MuJoCo turns meshes to their principal axes, a prism's being one of them: the flat side is
    # the one across which all points lie at only two heights.
    flat = int(np.argmin([len(np.unique(np.round(points[:, i], 7))) for i in range(3)]))
    across = [i for i in range(3) if i != flat]
    rings = []
    for side in (points[:, flat] < 0, points[:, flat] > 0):
        ring = points[side]
        order = np.argsort(np.arctan2(ring[:, across[1]], ring[:, across[0]]))
        rings.append(ring[order])
    return rings


FRAME_MS, MOST_FRAMES = 40, 250
"""25 frames a second, which all viewers show; what is longer than ten seconds is sped up."""
COLOURS = 128
SPED_UP = 1.05
"""Times as fast as in reality, from where on the picture says so."""


def animate(
    simulation: Simulation, kinematics: Kinematics, recording: Recording, picture: Path
) -> None:
    """Saves the GIF, which loops without a pause; InvalidInput where it cannot be saved so."""
    if picture.suffix.lower() != '.gif':
        raise InvalidInput(f'--animation {picture}: the name must end in .gif')
    style.use()
    times = recording.times
    chosen = frames_of(times)
    speed = float(times[-1]) / (1e-3 * FRAME_MS * len(chosen))
    scenes = [_scene(simulation, kinematics, recording, int(k)) for k in chosen]
    figure = plt.figure(figsize=(5, 4.2), dpi=100)
    canvas = FigureCanvasAgg(figure)
    axes, bounds = figure.add_axes((0, 0, 1, 1), projection='3d'), bounds_of(scenes)
    frames: list[Image.Image] = []
    for scene, k in zip(scenes, chosen, strict=True):
        draw_scene(axes, scene, bounds)
        label = f'{times[k]:.2f} s' + (f', {speed:.2g} × as fast' if speed > SPED_UP else '')
        axes.text2D(0.03, 0.03, label, transform=axes.transAxes)
        canvas.draw()
        image = Image.fromarray(np.asarray(canvas.buffer_rgba())).convert('RGB')
        # One palette for all, without dither: nothing flickers.
        palette = frames[0] if frames else image.quantize(COLOURS, dither=Image.Dither.NONE)
        frames.append(image.quantize(palette=palette, dither=Image.Dither.NONE))
    plt.close(figure)
    _write(frames, picture)


def frames_of(times: Array) -> Array:
    """Which rows of a recording are drawn: evenly, and not the last, which the first follows."""
    seconds = float(times[-1] - times[0])
    count = min(max(round(1e3 * seconds / FRAME_MS), 2), MOST_FRAMES)
    moments = times[0] + seconds * np.arange(count) / count
    rows: Array = np.searchsorted(times, moments - 1e-9)
    return rows


def _scene(simulation: Simulation, kinematics: Kinematics, recording: Recording, k: int) -> Shapes:
    pose = recording.poses[k]
    simulation.reset(pose, kinematics.inverse(pose, recording.joints[k]))
    return shapes(simulation)


def _write(frames: list[Image.Image], picture: Path) -> None:
    try:
        frames[0].save(picture, save_all=True, append_images=frames[1:], duration=FRAME_MS, loop=0)
    except (OSError, ValueError) as error:
        raise InvalidInput(f'cannot save {picture}: {reason(error)}') from error


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
