"""The whole page: 3D at the left, everything to press and to read at the right."""

from collections.abc import Callable
from html import escape
from typing import Any

import numpy as np

from hexarm.panel.controls import Buttons, GoalSliders, Requests
from hexarm.panel.gripper import GripperSlider
from hexarm.panel.readout import Plots, diagnostics_text
from hexarm.panel.scene import Scene
from hexarm.panel.view import Stance, View
from manipulator.arrays import Array
from manipulator.machine import Machine
from manipulator.pose import Pose
from manipulator.teleop.modes import MODES

JOYSTICK_HEIGHT = 200
FASTEST = 100


class Page:
    """Everything that a viser server shows of one machine; shared by all its viewers."""

    def __init__(
        self,
        server: Any,
        machine: Machine,
        has_gripper: bool,
        title: str,
        joystick: str,
        requests: Requests,
        request_goal: Callable[[Pose], None],
    ) -> None:
        gui = server.gui
        gui.configure_theme(dark_mode=True, show_logo=False, show_share_button=False,
                            control_width='large', brand_color=(88, 166, 255))  # fmt: skip
        gui.set_panel_label(title)
        gui.main_panel.dock_right()
        self.scene = Scene(server, machine, has_gripper)
        self._buttons = Buttons(gui, requests)
        tabs = gui.add_tab_group()
        with tabs.add_tab('Drive'):
            self.sliders = GoalSliders(gui, machine, request_goal)
            self._gripper = GripperSlider(gui, requests.grip) if has_gripper else None
            gui.add_html(joystick_frame(joystick))
            self._joystick_speed = gui.add_slider('joystick [%]', 1, FASTEST, 1, 40)
            modes = gui.add_dropdown('jog mode', tuple(MODES))
            modes.on_update(lambda event: requests.choose_mode(event.target.value))
        kinematics = machine.kinematics
        with tabs.add_tab('Plots'):
            self._plots = Plots(gui, kinematics.joint_names, kinematics.joint_unit)
        with tabs.add_tab('Nodes'):
            self._nodes = gui.add_markdown('')
        with tabs.add_tab('View'):
            self._view_options(gui)

    @property
    def joystick_share(self) -> float:
        """The part of the machine's speeds at full deflection."""
        return float(self._joystick_speed.value) / FASTEST

    def show(self, view: View, notice: str) -> None:
        """What moves: many times a second."""
        self.scene.show(view)
        self._buttons.show(view, notice)

    def show_speed(self, share: float) -> None:
        """The speed override that is set."""
        self._buttons.show_speed(share)

    def follow_gripper(self, measured: Stance | None) -> None:
        """The slider of the gripper shows where it is, where that is known."""
        if self._gripper is not None and measured is not None and measured.opening is not None:
            self._gripper.follow(measured.opening)

    def note(self, view: View, now: float) -> None:
        """A sample for the plots."""
        self._plots.note(view, now)

    def redraw(self, view: View) -> None:
        """What may lag: plots, the trail, the nodes' reports."""
        self._plots.draw()
        self.scene.draw_trail()
        text = diagnostics_text(view.nodes)
        if self._nodes.content != text:
            self._nodes.content = text

    def show_reach(self, surface: Array) -> None:
        """The hull, once it has been computed."""
        self.scene.show_reach(np.asarray(surface))
        self.scene.set_reach_visible(bool(self._is_reach_shown.value))

    def _view_options(self, gui: Any) -> None:
        self._is_reach_shown = gui.add_checkbox('show the reach', True)
        self._is_reach_shown.on_update(
            lambda event: self.scene.set_reach_visible(event.target.value)
        )
        gui.add_button('Clear the trail').on_click(lambda event: self.scene.clear_trail())
        gui.add_markdown(LEGEND)


LEGEND = """\
Cranks, rods and joints are **green** with room to spare, **amber** where a limit comes near and
**red** at it. Solid: as measured; pale blue: as commanded. The blue net is what the platform
reaches without turning."""


def joystick_frame(document: str) -> str:
    """The joystick, an HTML document of its own, within the page."""
    return (
        f'<iframe title="joystick" srcdoc="{escape(document, quote=True)}" scrolling="no" '
        f'style="width:100%;height:{JOYSTICK_HEIGHT}px;border:0;color-scheme:dark"></iframe>'
    )
