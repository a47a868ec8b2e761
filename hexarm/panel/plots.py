"""The last seconds of joints and errors, as curves."""

from collections import deque
from typing import Any

import numpy as np

from hexarm.panel.view import View
from manipulator.arrays import Array
from manipulator.pose import Pose

SECONDS = 20.0
JOINT_COLOURS = ('#58a6ff', '#3fb950', '#f5b041', '#e74c3c', '#bc8cff', '#39c5cf')
AXIS = {'stroke': '#8b949e', 'grid': {'stroke': '#30363d', 'width': 1}}


class Plots:
    """Joints measured (degrees or mm) and the distance from commanded to measured pose."""

    def __init__(self, gui: Any, names: tuple[str, ...], joint_unit: str) -> None:
        self._factor, unit = (180.0 / np.pi, '°') if joint_unit == 'rad' else (1e3, 'mm')
        self._rows: deque[Array] = deque()
        self._count = len(names)
        axes = (AXIS, AXIS)
        scales = {'x': {'time': False}}
        empty = np.zeros(1)
        self._joints = gui.add_uplot(
            (empty,) * (1 + self._count),
            ({}, *(_series(n, c) for n, c in zip(names, JOINT_COLOURS, strict=True))),
            title=f'Joints [{unit}]', axes=axes, scales=scales, aspect=1.4,
        )  # fmt: skip
        self._errors = gui.add_uplot(
            (empty,) * 3,
            ({}, _series('position [mm]', '#58a6ff'), _series('orientation [°]', '#f5b041')),
            title='Commanded to measured', axes=axes, scales=scales, aspect=1.6,
        )  # fmt: skip

    def note(self, view: View, now: float) -> None:
        """Keeps one sample, where something is measured."""
        if view.measured is None:
            return
        commanded = view.commanded
        gap = errors(commanded.pose, view.measured.pose) if commanded else np.full(2, np.nan)
        self._rows.append(np.concatenate([[now], view.measured.joints * self._factor, gap]))
        while self._rows[0][0] < now - SECONDS:
            self._rows.popleft()

    def draw(self) -> None:
        """Sends the curves to the pages."""
        if len(self._rows) < 2:
            return
        table = np.array(self._rows)
        ago = table[:, 0] - table[-1, 0]
        self._joints.data = (ago, *table[:, 1 : 1 + self._count].T.copy())
        self._errors.data = (ago, *table[:, 1 + self._count :].T.copy())


def errors(commanded: Pose, measured: Pose) -> Array:
    """(2,): how far apart two poses are, in mm and degrees."""
    offsets = commanded.twist_to(measured)
    return np.array([1e3 * np.linalg.norm(offsets[:3]), np.degrees(np.linalg.norm(offsets[3:]))])


def _series(name: str, colour: str) -> dict[str, Any]:
    return {'label': name, 'stroke': colour, 'width': 1.5}
