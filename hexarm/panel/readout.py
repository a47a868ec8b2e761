"""The page's readings: nodes' reports, the margin of each limit, curves of the last seconds."""

from collections import deque
from itertools import cycle
from typing import Any

import numpy as np

from hexarm.panel.view import NodeReport, View
from manipulator.arrays import Array
from manipulator.machine import Machine
from manipulator.pose import Pose

SIGNS = ('✓', '⚠', '✗', '✗')
"""By the level of a DiagnosticStatus; signs that every system's letters have."""

SILENT = 3.0
"""Seconds after which a node that reports once a second is shown as silent."""


def diagnostics_text(nodes: tuple[NodeReport, ...]) -> str:
    """One block for each node: its message, then its values."""
    if not nodes:
        return 'No node has reported yet.'
    return '\n\n'.join(_block(node) for node in nodes)


def _block(node: NodeReport) -> str:
    is_silent = node.age > SILENT
    sign = SIGNS[2] if is_silent else SIGNS[min(max(node.level, 0), 3)]
    message = f'silent for {node.age:.0f} s' if is_silent else node.message
    rows = [f'| {_cell(name)} | {_cell(value)} |' for name, value in node.values.items() if value]
    table = '\n'.join(['| | |', '|---|---|', *rows]) if rows else ''
    return f'{sign} **{_cell(node.name)}** {_cell(message)}\n\n{table}'


def _cell(text: str) -> str:
    """Without what would end the cell or begin markup; underscores as they are in keys."""
    clean = ' '.join(text[:120].split())
    for sign in '\\|<>*_`[]':
        clean = clean.replace(sign, f'\\{sign}')
    return clean


GOOD, NARROW, NONE_LEFT = (18, 150, 84), (224, 130, 8), (206, 32, 22)
COMFORTABLE = 0.35
"""The share of a limit's room from which everything is well."""


def shares(machine: Machine, pose: Pose, joints: Array) -> dict[str, float]:
    """By owner ('leg 3', 'joint 2', '' for the whole machine), the least share of room left.

    1 in the middle of a range, 0 at its end, negative beyond. A range with one end is taken to
    be as wide as home is far from that end.
    """
    home = machine.kinematics.home
    at_home = machine.kinematics.inverse(home)
    found: dict[str, float] = {}
    for limit in machine.constraints.limits:
        room = _room(limit.values(home, at_home), limit.low, limit.high)
        values = limit.values(pose, joints)
        left = np.fmin(values - limit.low, limit.high - values) / room
        for owner, share in zip(limit.owners, left, strict=True):
            if np.isfinite(share):
                found[owner] = min(found.get(owner, 1.0), float(share))
    return found


def colour(share: float) -> tuple[int, int, int]:
    """Green with room to spare, amber where it gets narrow, red at the limit."""
    at = float(np.clip(share / COMFORTABLE, 0.0, 1.0))
    lower, upper, part = (NONE_LEFT, NARROW, 2 * at) if at < 0.5 else (NARROW, GOOD, 2 * at - 1)
    red, green, blue = (round(a + part * (b - a)) for a, b in zip(lower, upper, strict=True))
    return red, green, blue


def _room(home: Array, low: Array, high: Array) -> Array:
    """Half of each range, or home's distance from the one end that there is."""
    half = (high - low) / 2
    nearer = np.fmin(home - low, high - home)
    return np.where(np.isfinite(half), half, np.maximum(nearer, 1e-9))


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
            ({}, *(_series(n, c) for n, c in zip(names, cycle(JOINT_COLOURS), strict=False))),
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
