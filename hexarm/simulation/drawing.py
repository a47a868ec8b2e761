"""What a simulated machine looks like: rods as segments, plates and loads as outlines."""

from dataclasses import dataclass

import mujoco
import numpy as np

from hexarm.simulation.simulation import Simulation
from manipulator.arrays import Array, frozen

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
