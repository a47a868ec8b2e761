"""The machine as solids in a viser scene: once as measured, once as commanded."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from hexarm.link_meshes import LinkMesh
from hexarm.panel.gripper import fingers
from hexarm.panel.mesh_body import MeshBody
from hexarm.panel.pieces import (
    PLAIN,
    Colours,
    Pieces,
    bar,
    colours,
    hull,
    pieces,
    plate,
    sphere,
    wxyz_of,
)
from hexarm.panel.view import Stance
from manipulator.kinematics import Kinematics

STILL = 2e-5
"""Metres and radians below which a change is not drawn."""

PLATE, PLATE_OPACITY = 0.02, 0.6
"""Thickness by the machine's size; the trail and the reach are seen through it."""

HALF_OPEN = 0.5
"""How a gripper is drawn of which nothing is known."""

GHOST_OPACITY = 0.28
GHOST = (120, 190, 255)


class Body:
    """One drawing of the machine under the scene's name `name`; lengths times `scale`."""

    def __init__(
        self,
        scene: Any,
        name: str,
        kinematics: Kinematics,
        scale: float,
        *,
        has_gripper: bool = False,
        is_ghost: bool = False,
        meshes: Sequence[LinkMesh | None] = (),
    ) -> None:
        self._kinematics = kinematics
        self._scale = scale
        self._has_gripper = has_gripper
        self._is_ghost = is_ghost
        self._shown: Stance | None = None
        home = kinematics.home
        joints = kinematics.inverse(home)
        self._meshes: MeshBody | None = None
        found = self._pieces(Stance(home, joints))
        if any(meshes):
            owners = found.ball_owners
            self._meshes = MeshBody(scene, name, kinematics, scale, meshes, owners)
            self._meshes.show(Stance(home, joints), {})
            found = self._pieces(Stance(home, joints))
        style: dict[str, Any] = {'opacity': GHOST_OPACITY if is_ghost else None, 'lod': 'off'}
        style |= {'cast_shadow': not is_ghost, 'receive_shadow': not is_ghost}
        vertices, faces = bar()
        self._bars = scene.add_batched_meshes_simple(
            f'{name}/bars', vertices, faces, found.bars.wxyz, found.bars.starts,
            batched_scales=found.bars.sizes.astype(np.float32),
            batched_colors=self._bar_colours(found, {}), **style,
        )  # fmt: skip
        ball, ball_faces = hull(sphere(9, 14))
        count = len(found.balls)
        self._balls = scene.add_batched_meshes_simple(
            f'{name}/balls', ball, ball_faces, np.tile([1.0, 0.0, 0.0, 0.0], (count, 1)),
            found.balls, batched_scales=found.ball_radii.astype(np.float32),
            batched_colors=self._ball_colours(found, {}), **style,
        )  # fmt: skip
        self._plate = self._add_plate(scene, name, Stance(home, joints), style)

    def show(self, stance: Stance, left: dict[str, float]) -> None:
        """Moves every piece to a stance; `left` is the share of room left by owner.

        Nothing is sent for a machine at rest: pages draw only what changes.
        """
        if self._shown is not None and _are_alike(stance, self._shown):
            return
        self._shown = stance
        if self._meshes is not None:
            self._meshes.show(stance, left)
        found = self._pieces(stance)
        self._bars.batched_positions = found.bars.starts.astype(np.float32)
        self._bars.batched_wxyzs = found.bars.wxyz.astype(np.float32)
        self._bars.batched_scales = found.bars.sizes.astype(np.float32)
        self._balls.batched_positions = found.balls.astype(np.float32)
        if not self._is_ghost:
            self._recolour(self._bars, self._bar_colours(found, left))
            self._recolour(self._balls, self._ball_colours(found, left))
        if self._plate is not None:
            self._plate.position = stance.pose.position * self._scale
            self._plate.wxyz = wxyz_of(stance.pose)

    def set_visible(self, is_visible: bool) -> None:
        """Shows or hides all of it."""
        for handle in (self._bars, self._balls, self._plate):
            if handle is not None and handle.visible != is_visible:
                handle.visible = is_visible

    def _pieces(self, stance: Stance) -> Pieces:
        strokes = self._kinematics.skeleton(stance.pose, stance.joints)
        if self._has_gripper:
            opening = HALF_OPEN if stance.opening is None else stance.opening
            strokes += fingers(stance.pose, opening, 1.0 / self._scale)
        scaled = tuple(replace(s, points=s.points * self._scale) for s in strokes)
        found = pieces(scaled)
        if self._meshes is not None:
            self._meshes.hide_rods(found)
        return found

    def _bar_colours(self, found: Pieces, left: dict[str, float]) -> Colours:
        if self._is_ghost:
            return np.tile(np.array(GHOST, dtype=np.uint8), (len(found.parts), 1))
        return colours(found.parts, found.owners, left)

    def _ball_colours(self, found: Pieces, left: dict[str, float]) -> Colours:
        if self._is_ghost:
            return np.tile(np.array(GHOST, dtype=np.uint8), (len(found.balls), 1))
        return colours(('link',) * len(found.balls), found.ball_owners, left)

    @staticmethod
    def _recolour(handle: Any, new: Colours) -> None:
        if not np.array_equal(handle.batched_colors, new):
            handle.batched_colors = new

    def _add_plate(self, scene: Any, name: str, stance: Stance, style: dict[str, Any]) -> Any:
        """The platform as a plate, where the machine has one."""
        strokes = self._kinematics.skeleton(stance.pose, stance.joints)
        outlines = [s.points[:-1] for s in strokes if s.part == 'platform']
        if not outlines:
            return None
        outline = outlines[-1]  # the uppermost of a stack
        inside = stance.pose.inverse().transform(outline) * self._scale
        vertices, faces = plate(inside, PLATE)
        style = {key: value for key, value in style.items() if key != 'lod'}
        style['opacity'] = GHOST_OPACITY if self._is_ghost else PLATE_OPACITY
        tint = GHOST if self._is_ghost else PLAIN['platform']
        return scene.add_mesh_simple(f'{name}/plate', vertices, faces, color=tint, side='double',
                                     flat_shading=True, **style)  # fmt: skip


def _are_alike(a: Stance, b: Stance) -> bool:
    """Whether the difference is invisible."""
    offsets = np.abs(a.pose.twist_to(b.pose)).max()
    is_grip_alike = a.opening == b.opening
    return is_grip_alike and bool(max(offsets, np.abs(a.joints - b.joints).max()) < STILL)
