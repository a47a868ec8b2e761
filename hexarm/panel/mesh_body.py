"""An arm's links as the solids of its meshes, tinted by their joints' margins."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from hexarm.link_meshes import LinkMesh
from hexarm.panel.pieces import Pieces, wxyz_of
from hexarm.panel.room import colour
from hexarm.panel.view import Stance
from manipulator.kinematics import Kinematics
from manipulator.pose import Pose

PAINT = np.array([205, 208, 214])
TINT = 0.55
"""Of the margin's colour in a link's; the base has the paint alone."""


class MeshBody:
    """The base and the links with a mesh, under the scene's name `name`; lengths times `scale`.

    owners are the joints whose margins each shows, '' for none.
    """

    def __init__(
        self,
        scene: Any,
        name: str,
        kinematics: Kinematics,
        scale: float,
        meshes: Sequence[LinkMesh | None],
        owners: Sequence[str],
    ) -> None:
        self._kinematics = kinematics
        self._scale = scale
        self._owners = owners
        self._at_zero = self._places(
            Stance(kinematics.home, np.zeros(len(kinematics.joint_names)))
        )
        self._solids = {
            i: self._add(scene, f'{name}/mesh_{i}', mesh)
            for i, mesh in enumerate(meshes)
            if mesh is not None
        }

    def hide_rods(self, found: Pieces) -> None:
        """Makes nothing of the bars of links with a mesh, and of the balls at their beginnings.

        The last link's has a ball at its end as well, the tool's.
        """
        links = list(self._solids)
        balls = links + [i + 1 for i in links if i == len(self._at_zero) - 1]
        found.bars.sizes[links] = 0.0
        found.ball_radii[balls] = 0.0

    def show(self, stance: Stance, left: dict[str, float]) -> None:
        """Moves and tints every solid; `left` is the share of room left by owner."""
        places = self._places(stance)
        for i, solid in self._solids.items():
            moved = places[i] @ self._at_zero[i].inverse()
            solid.position, solid.wxyz = moved.position * self._scale, wxyz_of(moved)
            tint = self._tint(self._owners[i], left)
            if tuple(solid.color) != tint:
                solid.color = tint

    def _places(self, stance: Stance) -> list[Pose]:
        """Of the base and each link; the tool, which comes last, has no mesh."""
        links = self._kinematics.links(stance.pose, stance.joints)[:-1]
        return [Pose.identity(), *(link.pose for link in links)]

    def _tint(self, owner: str, left: dict[str, float]) -> tuple[int, int, int]:
        share = TINT if owner else 0.0
        mixed = (1 - share) * PAINT + share * np.array(colour(left.get(owner, 1.0)))
        red, green, blue = np.rint(mixed).astype(int).tolist()
        return red, green, blue

    def _add(self, scene: Any, name: str, mesh: LinkMesh) -> Any:
        """Flat faces, from both sides: many meshes have some that are turned inside out."""
        corners = mesh.triangles.reshape(-1, 3)
        vertices, faces = np.unique(corners, axis=0, return_inverse=True)
        return scene.add_mesh_simple(
            name, vertices * self._scale, faces.reshape(-1, 3), color=tuple(PAINT.tolist()),
            flat_shading=True, side='double',
        )  # fmt: skip
