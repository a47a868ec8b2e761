"""The 3D part of the page: the machine, its reach, its trail, its pivot and its goal.

Everything is drawn in base axes, lengths divided by the machine's size: so light, camera and line
widths suit a platform of the size of a hand and an arm of the size of a man alike.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np

from hexarm.link_meshes import LinkMesh
from hexarm.panel.body import Body
from hexarm.panel.nearness import BOX_COLOUR, Nearness
from hexarm.panel.pieces import hull, wxyz_of
from hexarm.panel.room import shares
from hexarm.panel.view import Stance, View
from manipulator.arrays import Array
from manipulator.limits.surroundings import STAY_IN
from manipulator.machine import Machine
from manipulator.pose import Pose

TRAIL = 600
STILL = 1e-4
APART = 5e-3
"""Of the machine's size, or radians, from which the commanded machine is drawn beside it."""

TRAIL_STEP = 0.004
TRAIL_COLOUR, HULL_COLOUR = (255, 200, 87), (150, 190, 255)
REACH_LOOKS: dict[str, dict[str, Any]] = {
    'solid': {'opacity': 0.07},
    'net': {'wireframe': True, 'opacity': 0.22},
}
CAMERA = np.array([1.2, -1.4, 0.95])


class Scene:
    """What a viser server shows in three dimensions."""

    def __init__(
        self,
        server: Any,
        machine: Machine,
        has_gripper: bool,
        meshes: Sequence[LinkMesh | None] = (),
    ) -> None:
        server.gui.configure_theme(dark_mode=True)
        self._scene = server.scene
        self._machine = machine
        kinematics = machine.kinematics
        strokes = kinematics.skeleton(kinematics.home, kinematics.inverse(kinematics.home))
        points = np.vstack([stroke.points for stroke in strokes])
        self._scale = 1.0 / float(np.ptp(points, axis=0).max())
        low, high = points.min(axis=0) * self._scale, points.max(axis=0) * self._scale
        self._floor_height = float(min(low[2], 0.0)) - 0.06
        boxes = self._surroundings()
        self._near = Nearness(self._scene, machine, self._scale, boxes)
        self._floor()
        self._camera(server, (low + high) / 2, float(high[2] - low[2]))
        style = kinematics, self._scale
        self._measured = Body(
            self._scene, '/measured', *style, has_gripper=has_gripper, meshes=meshes
        )
        self._commanded = Body(self._scene, '/commanded', *style, is_ghost=True)
        self._pivot = self._add_axes('/pivot', 0.16, 0.006)
        self._goal = self._add_axes('/goal', 0.22, 0.004)
        self._reach: list[Any] = []
        self._trail: list[Array] = []
        self._trail_handle: Any = None
        self._trail_is_new = False

    def show(self, view: View) -> None:
        """Moves what moves; what is not known is hidden or stays where it was."""
        if view.measured is not None:
            left = shares(self._machine, view.measured.pose, view.measured.joints)
            self._measured.show(view.measured, left)
            frames = view.frames
            self._near.show(view.measured, frames.T_platform_pivot.position * bool(frames.tool))
            pivot = view.measured.pose @ frames.T_platform_pivot
            self._place(self._pivot, pivot)
            self._remember(pivot.position * self._scale)
        is_apart = view.commanded is not None and self._are_apart(view.commanded, view.measured)
        self._commanded.set_visible(is_apart)
        if is_apart and view.commanded is not None:
            self._commanded.show(view.commanded, {})

    def show_goal(self, goal: Pose) -> None:
        """Puts the goal's axes at the pose of the sliders."""
        self._place(self._goal, goal)

    def show_reach(self, surface: Array) -> None:
        """Draws the positions reached with home's orientation, a grid from pole to pole."""
        vertices, faces = hull(surface * self._scale)
        is_cut = bool(vertices[:, 2].min() < self._floor_height)
        styles = {'net': REACH_LOOKS['net']} if is_cut else REACH_LOOKS  # a floor cuts in patches
        self._reach = [
            self._scene.add_mesh_simple(
                f'/reach/{name}', vertices, faces, color=HULL_COLOUR, side='double',
                cast_shadow=False, receive_shadow=False, **style,
            )
            for name, style in styles.items()
        ]  # fmt: skip

    def set_reach_visible(self, is_visible: bool) -> None:
        """Shows or hides the hull."""
        for handle in self._reach:
            handle.visible = is_visible

    def draw_trail(self) -> None:
        """Draws the trail again, where it grew; called a few times a second."""
        if not self._trail_is_new or len(self._trail) < 2:
            return
        self._trail_is_new = False
        points = np.array(self._trail)
        self._trail_handle = self._scene.add_line_segments(
            '/trail', np.stack([points[:-1], points[1:]], axis=1), TRAIL_COLOUR, line_width=2.5
        )

    def clear_trail(self) -> None:
        """Forgets the trail."""
        self._trail.clear()
        if self._trail_handle is not None:
            self._trail_handle.remove()
            self._trail_handle = None

    def _are_apart(self, commanded: Stance, measured: Stance | None) -> bool:
        """Whether both can be distinguished: a ghost in the same place only dulls the colours."""
        if measured is None:
            return True
        gap = np.abs(commanded.pose.twist_to(measured.pose))
        return bool(gap[:3].max() * self._scale > APART or gap[3:].max() > APART)

    def _remember(self, point: Array) -> None:
        if self._trail and np.linalg.norm(point - self._trail[-1]) < TRAIL_STEP:
            return
        self._trail.append(point)
        del self._trail[:-TRAIL]
        self._trail_is_new = True

    def _add_axes(self, name: str, length: float, radius: float) -> Any:
        home = self._machine.kinematics.home
        return self._scene.add_frame(
            name, axes_length=length, axes_radius=radius, origin_radius=2.2 * radius,
            position=home.position * self._scale, wxyz=wxyz_of(home),
        )  # fmt: skip

    def _place(self, handle: Any, pose: Pose) -> None:
        position = pose.position * self._scale
        if not np.allclose(handle.position, position, atol=STILL):
            handle.position = position
        if not np.allclose(handle.wxyz, wxyz_of(pose), atol=STILL):
            handle.wxyz = wxyz_of(pose)

    def _surroundings(self) -> dict[int, Any]:
        """What the machine may not meet, by number; the grid lies where its floor is."""
        boxes = {}
        for i, obstacle in enumerate(self._machine.obstacles):
            low, high = obstacle.corners * self._scale
            if obstacle.is_endless:
                self._floor_height = float(low[2])
                continue
            is_workspace = obstacle.side == STAY_IN
            boxes[i] = self._scene.add_box(
                f'/surroundings/{i}', BOX_COLOUR, tuple(high - low), position=(low + high) / 2,
                wireframe=is_workspace, opacity=0.25 if is_workspace else 0.55, cast_shadow=False,
                receive_shadow=False,
            )  # fmt: skip
        return boxes

    def _floor(self) -> None:
        self._scene.add_grid(
            '/floor', width=6.0, height=6.0, cell_size=0.1, section_size=0.5, plane='xy',
            cell_color=(48, 54, 61), section_color=(68, 76, 86),
            position=(0.0, 0.0, self._floor_height), shadow_opacity=0.0,
        )  # fmt: skip
        self._scene.world_axes.visible = False
        self._scene.configure_default_lights(cast_shadow=False)  # shadows cost most of the drawing

    def _camera(self, server: Any, centre: Array, height: float) -> None:
        """Turns the camera to the whole machine: from further away where it is tall."""
        server.initial_camera.position = tuple(centre + (0.7 + 0.45 * height) * CAMERA)
        server.initial_camera.look_at = tuple(centre)
        server.initial_camera.fov = 0.75
