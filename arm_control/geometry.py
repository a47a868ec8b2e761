"""A serial arm in its machine file: four forms of geometry, each as a `Chain`."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from arm_control.chain import JOINTS, Chain
from manipulator.arrays import Array
from manipulator.config import PLACE_MM, SIZE_MM, TURN_DEG, key, quantity
from manipulator.errors import ConfigError
from manipulator.formatting import counted, length
from manipulator.pose import Pose

SixAngles = tuple[float, float, float, float, float, float]
Three = tuple[float, float, float]
Meshes = tuple[str, str, str, str, str, str, str] | None
MESHES = (
    'binary STL files of the base and the six links, beside this file: m, base axes at zero '
    "angles; '' for a link that is drawn as a rod"
)

LONG_LINK, SHORTEST_ARM, LONGEST_ARM = 5.0, 0.02, 200.0
"""Metres: between two joints, and from the base through all of them to the tool."""

PROPORTION = 150.0
"""Of the longest link to the next: beyond it, one of both is in another unit."""

HOME_ANGLES = 'joint angles at home'
FAR_MM = 1e8
"""Along an axis a point may lie as far off as a double keeps to 0.01 µm, for `placed` moves it."""

MOST_DEG = 360_000.0
"""Of a joint range or a home position: a thousand turns either way, by gears and winches."""


@dataclass(frozen=True)
class LengthsConfig:
    """The arm of Fadeev and Loginov: straight up along z at zero angles, wrist centre C on top.

    Joint axes z, −x, −x, z, −x, z (docs/arm-kinematics.md, 2); tool_mm is from C to the tool.
    """

    L1_mm: float = quantity(0, PLACE_MM[1], 'from the base to joint 2')
    L2_mm: float = quantity(*SIZE_MM, 'from joint 2 to joint 3')
    L3_mm: float = quantity(*SIZE_MM, 'from joint 3 to the centre of the wrist')
    tool_mm: float = quantity(0, PLACE_MM[1], 'from there to the tool')
    home_deg: SixAngles = quantity(-MOST_DEG, MOST_DEG, HOME_ANGLES)
    meshes: Meshes = key(MESHES, default=None)

    def chain(self) -> Chain:
        """Axes and points by the paper's figure 1."""
        shoulder = self.L1_mm * 1e-3
        elbow = shoulder + self.L2_mm * 1e-3
        wrist = elbow + self.L3_mm * 1e-3
        up, across = [0.0, 0.0, 1.0], [-1.0, 0.0, 0.0]
        heights = np.array([0.0, shoulder, elbow, wrist, wrist, wrist])
        return Chain(
            np.array([up, across, across, up, across, up]),
            np.outer(heights, up),
            Pose(np.array([0.0, 0.0, wrist + self.tool_mm * 1e-3]), np.eye(3)),
        )


@dataclass(frozen=True)
class DhRow:
    """One line of a Denavit–Hartenberg table; offset_deg is θ at joint angle zero.

    Between axes that are almost parallel, as in a calibrated UR, d is huge and says nothing of the
    arm's size: the next ones take it back. `placed` judges the size.
    """

    a_mm: float = quantity(*PLACE_MM, 'along the x axis')
    alpha_deg: float = quantity(*TURN_DEG, 'about the x axis')
    d_mm: float = quantity(-FAR_MM, FAR_MM, 'along the joint axis')
    offset_deg: float = quantity(*TURN_DEG, 'θ at joint angle 0', default=0.0)


@dataclass(frozen=True)
class DhConfig:
    """Standard Denavit–Hartenberg parameters: each link is Rz(θ)·Tz(d)·Tx(a)·Rx(α)."""

    dh: tuple[DhRow, DhRow, DhRow, DhRow, DhRow, DhRow] = key('standard Denavit–Hartenberg table')
    home_deg: SixAngles = quantity(-MOST_DEG, MOST_DEG, HOME_ANGLES)
    tool_mm: float = quantity(0, PLACE_MM[1], 'to the tool along z of frame 6', default=0.0)
    meshes: Meshes = key(MESHES, default=None)

    def chain(self) -> Chain:
        """Joint i turns about the z axis of frame i − 1; the tool lies along z of frame 6."""
        frame = np.eye(4)
        axes, points = [], []
        for row in self.dh:
            axes.append(frame[:3, 2])
            points.append(frame[:3, 3])
            frame = frame @ _about_z(row) @ _along_x(row)
        return _chain(axes, points, frame, self.tool_mm)


@dataclass(frozen=True)
class ModifiedDhConfig:
    """Modified Denavit–Hartenberg parameters (Craig): each link is Rx(α)·Tx(a)·Rz(θ)·Tz(d).

    Row i holds α and a of the link before joint i: often written αᵢ₋₁ and aᵢ₋₁.
    """

    modified_dh: tuple[DhRow, DhRow, DhRow, DhRow, DhRow, DhRow] = key(
        'modified Denavit–Hartenberg table (Craig): α and a of the link before the joint'
    )
    home_deg: SixAngles = quantity(-MOST_DEG, MOST_DEG, HOME_ANGLES)
    tool_mm: float = quantity(0, PLACE_MM[1], 'to the tool along z of frame 6', default=0.0)
    meshes: Meshes = key(MESHES, default=None)

    def chain(self) -> Chain:
        """Joint i turns about the z axis of frame i; the tool lies along z of frame 6."""
        frame = np.eye(4)
        axes, points = [], []
        for row in self.modified_dh:
            frame = frame @ _along_x(row)
            axes.append(frame[:3, 2])
            points.append(frame[:3, 3])
            frame = frame @ _about_z(row)
        return _chain(axes, points, frame, self.tool_mm)


@dataclass(frozen=True)
class Screw:
    """A joint axis at zero angles, right-handed, of any length but zero, and a point on it."""

    axis: Three = quantity(-1000, 1000, 'direction, right-handed, of any length')
    point_mm: Three = quantity(-FAR_MM, FAR_MM, 'a point on it')

    def __post_init__(self) -> None:
        """Raises ConfigError for an axis without direction."""
        if np.linalg.norm(self.axis) < 1e-6:
            raise ConfigError([f'axis: {list(self.axis)} has no direction'])


@dataclass(frozen=True)
class ScrewsConfig:
    """Joint axes in base axes at zero angles, and the tool's pose there."""

    screws: tuple[Screw, Screw, Screw, Screw, Screw, Screw] = key(
        'joint axes in base axes at zero angles'
    )
    tool_position_mm: Three = quantity(*PLACE_MM, 'the tool there')
    tool_rpy_deg: Three = quantity(*TURN_DEG, 'its roll, pitch and yaw')
    home_deg: SixAngles = quantity(-MOST_DEG, MOST_DEG, HOME_ANGLES)
    meshes: Meshes = key(MESHES, default=None)

    def chain(self) -> Chain:
        """As given, with axes of unit length."""
        axes = np.array([screw.axis for screw in self.screws])
        return Chain(
            axes / np.linalg.norm(axes, axis=1, keepdims=True),
            np.array([screw.point_mm for screw in self.screws]) * 1e-3,
            Pose.from_xyz_rpy(
                np.array(self.tool_position_mm) * 1e-3, np.radians(self.tool_rpy_deg)
            ),
        )


ArmGeometry = LengthsConfig | DhConfig | ModifiedDhConfig | ScrewsConfig


def check_axes(geometry: Mapping[str, Any], limits: Mapping[str, Any]) -> None:
    """Raises ConfigError, with one sentence, for an arm of another number of axes than six."""
    lists = {f'geometry.{form}': geometry.get(form) for form in ('dh', 'modified_dh', 'screws')}
    for place, rows in (lists | {'limits.joints': limits.get('joints')}).items():
        if isinstance(rows, list) and len(rows) != JOINTS:
            raise ConfigError([f'{place}: has {other_axes(len(rows))}'])


def other_axes(count: int) -> str:
    """The part of an error about an arm with `count` axes, which are not six."""
    there = counted(count, 'axis', 'axes')
    return f'{there}, arms with 6 are supported; 5 and 7 are planned'


def placed(chain: Chain) -> Chain:
    """The same chain with each point that is far along its axis moved next to the one before.

    Raises ConfigError for an arm that is out of proportion even so.
    """
    points, before = np.array(chain.points), np.zeros(3)
    for i, axis in enumerate(chain.axes):
        away = points[i] - before
        if np.linalg.norm(away) > LONG_LINK:
            points[i] -= np.dot(away, axis) * axis
        before = points[i]
    _check_size(np.vstack([np.zeros(3), points, chain.home.position]))
    return Chain(chain.axes, points, chain.home)


def _check_size(places: Array) -> None:
    """Of base, joints and tool, (n, 3) in metres."""
    links = np.linalg.norm(np.diff(places, axis=0), axis=1)
    names = ['the base', *(f'joint {i}' for i in range(1, len(links))), 'the tool']
    longest = int(np.argmax(links))
    next_long = float(np.sort(links)[-2])
    if links[longest] > PROPORTION * next_long > 0.0:
        gap = f'{names[longest + 1]} is {length(links[longest])} from {names[longest]}'
        others = f'the next link is {length(next_long)} long'
        raise ConfigError([f'geometry: {gap}, {others}: is it in another unit?'])
    if not SHORTEST_ARM <= links.sum() <= LONGEST_ARM:
        whole = f'all links together are {length(links.sum())}'
        ends = f'{length(SHORTEST_ARM)} to {length(LONGEST_ARM)} fit'
        raise ConfigError([f'geometry: {whole}, {ends}: is it in another unit?'])


def _about_z(row: DhRow) -> Array:
    """Rz(θ)·Tz(d), which commute."""
    cosine, sine = _of(row.offset_deg)
    d = row.d_mm * 1e-3
    return np.array([[cosine, -sine, 0, 0], [sine, cosine, 0, 0], [0, 0, 1, d], [0, 0, 0, 1.0]])


def _along_x(row: DhRow) -> Array:
    """Tx(a)·Rx(α), which commute."""
    cosine, sine = _of(row.alpha_deg)
    a = row.a_mm * 1e-3
    return np.array([[1, 0, 0, a], [0, cosine, -sine, 0], [0, sine, cosine, 0], [0, 0, 0, 1.0]])


def _of(degrees: float) -> tuple[float, float]:
    """Cosine and sine."""
    return float(np.cos(np.radians(degrees))), float(np.sin(np.radians(degrees)))


def _chain(axes: list[Array], points: list[Array], frame: Array, tool_mm: float) -> Chain:
    """With a tool along z of the last frame."""
    tool = frame[:3, 3] + tool_mm * 1e-3 * frame[:3, 2]
    return Chain(np.array(axes), np.array(points), Pose(tool, frame[:3, :3]))
