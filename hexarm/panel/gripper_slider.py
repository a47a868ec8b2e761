"""A slider for the gripper: how far it is open, and how far it shall be; the same on all pages."""

from collections.abc import Callable
from typing import Any

STEP = 1
"""Percent."""


class GripperSlider:
    """Shows where the gripper is; a hand's move calls `wish` with 0 (closed) to 1 (open)."""

    def __init__(self, gui: Any, wish: Callable[[float], None]) -> None:
        self._wish = wish
        marks = ((0, 'closed'), (100, 'open'))
        self._slider = gui.add_slider('gripper [%]', 0, 100, STEP, 50, marks=marks)
        self._slider.on_update(self._on_update)

    def follow(self, opening: float) -> None:
        """Shows an opening without asking for it."""
        percent = round(100 * opening)
        if self._slider.value != percent:
            self._slider.value = percent

    def _on_update(self, event: Any) -> None:
        if event.client_id is not None:  # a hand's, not `follow`'s
            self._wish(event.target.value / 100)
