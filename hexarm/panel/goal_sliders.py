"""Six sliders for the goal, the same on every page, each with the range that is reachable now.

Millimetres and degrees on the page, metres and radians everywhere else. Moving a slider by hand
asks for the goal; `follow` moves the sliders without asking.
"""

from collections.abc import Callable
from typing import Any

import numpy as np

from hexarm.panel.reachable import AXES, bounds, coordinates, pose_at
from manipulator.arrays import Array
from manipulator.machine import Machine
from manipulator.pose import Pose

UNITS = np.array([1e3] * 3 + [180.0 / np.pi] * 3)
NAMES = tuple(f'{axis} [{unit}]' for axis, unit in zip(AXES, ['mm'] * 3 + ['°'] * 3, strict=True))
STEP = 0.1


class GoalSliders:
    """What a person asks for; `wish` is called with the pose at every move of a slider by hand."""

    def __init__(self, gui: Any, machine: Machine, wish: Callable[[Pose], None]) -> None:
        home = coordinates(machine.kinematics.home)
        limits = np.round(bounds(machine) * UNITS[:, None], 1)
        self._wish = wish
        self._low, self._high = limits[:, 0], limits[:, 1]
        self._centre = home
        self._sliders = [
            gui.add_slider(name, float(low), float(high), STEP, float(np.clip(value, low, high)))
            for name, low, high, value in zip(
                NAMES, self._low, self._high, np.round(home * UNITS, 1), strict=True
            )
        ]
        self._values = home
        self._reach = gui.add_markdown('')
        for k, slider in enumerate(self._sliders):
            slider.on_update(self._moved(k))

    @property
    def pose(self) -> Pose:
        """The pose that the sliders show."""
        return pose_at(self._values)

    def follow(self, pose: Pose) -> None:
        """Shows another pose without asking for it: the machine went there by other means."""
        values = coordinates(pose, self._centre)
        shown = np.clip(np.round(values * UNITS, 1), self._low, self._high)
        self._values = values
        for slider, value in zip(self._sliders, shown.tolist(), strict=True):
            if abs(slider.value - value) > STEP / 2:
                slider.value = value

    def show_reach(self, pose: Pose, ranges: Array, reason: str) -> None:
        """Marks on each slider how far it alone may go from `pose`; the reason where nowhere."""
        values = coordinates(pose, self._centre)[:, None]
        ends = np.clip((values + ranges) * UNITS[:, None], self._low[:, None], self._high[:, None])
        for slider, (low, high) in zip(self._sliders, ends.tolist(), strict=True):
            marks = () if reason else ((low, f'{low:.1f}'), (high, f'{high:.1f}'))
            slider._marks = slider_marks(marks)
        self._reach.content = f'⚠ {reason}' if reason else ''

    def _moved(self, axis: int) -> Callable[[Any], None]:
        def on_update(event: Any) -> None:
            if event.client_id is None:  # set by `follow`, not by a hand
                return
            values = self._values.copy()
            values[axis] = event.target.value / UNITS[axis]
            self._values = values
            self._wish(pose_at(values))

        return on_update


def slider_marks(marks: tuple[tuple[float, str], ...]) -> tuple[Any, ...]:
    """Marks in the form that a slider which already exists takes them."""
    from viser._messages import GuiSliderMark  # noqa: PLC0415

    return tuple(GuiSliderMark(value=value, label=label) for value, label in marks)
