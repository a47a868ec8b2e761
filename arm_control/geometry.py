"""A serial arm in its machine file: three forms of geometry, each as a `Chain`; joint limits."""

from dataclasses import dataclass

import numpy as np

from arm_control.chain import Chain
from manipulator.arrays import Array, frozen
from manipulator.config import PLACE_MM, RATE, SIZE_MM, TURN_DEG, key, quantity
from manipulator.errors import ConfigError
from manipulator.formatting import length
from manipulator.limits.constraints import Constraints
from manipulator.limits.machine_limits import JointRange
from manipulator.pose import Pose

JOINTS = 6
SixAngles = tuple[float, float, float, float, float, float]
Three = tuple[float, float, float]

LONG_LINK, SHORTEST_ARM, LONGEST_ARM = 5.0, 0.02, 200.0
"""Metres: between two joints, and from the base through all of them to the tool."""

PROPORTION = 50.0
"""Of the longest link to the others: beyond it, one of both is in another unit."""

HOME_ANGLES = 'joint angles at home'
FAR_MM = 1e8
"""Along an axis a point may lie as far off as a double keeps to 0.01 µm, for `placed` moves it."""


@dataclass(frozen=True)
class LengthsConfig:
    """The arm of Fadeev and Loginov: straight up along z at zero angles, wrist centre C on top.

    Joint axes z, −x, −x, z, −x, z (docs/arm-kinematics.md, 2); tool_mm is from C to the tool.
    """

    L1_mm: float = quantity(0, PLACE_MM[1], 'from the base to joint 2')
    L2_mm: float = quantity(*SIZE_MM, 'from joint 2 to joint 3')
    L3_mm: float = quantity(*SIZE_MM, 'from joint 3 to the centre of the wrist')
    tool_mm: float = quantity(0, PLACE_MM[1], 'from there to the tool')
    home_deg: SixAngles = quantity(*TURN_DEG, HOME_ANGLES)

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
    """One line of a standard Denavit–Hartenberg table; offset_deg is θ at joint angle zero.

    Between axes that are almost parallel, as in a calibrated UR, d is huge and says nothing of the
    arm's size: the next ones take it back. `placed` judges the size.
    """

    a_mm: float = quantity(*PLACE_MM, 'along the new x axis')
    alpha_deg: float = quantity(*TURN_DEG, 'about the new x axis')
    d_mm: float = quantity(-FAR_MM, FAR_MM, 'along the old z axis')
    offset_deg: float = quantity(*TURN_DEG, 'θ at joint angle 0', default=0.0)


@dataclass(frozen=True)
class DhConfig:
    """Standard Denavit–Hartenberg parameters: each link is Rz(θ)·Tz(d)·Tx(a)·Rx(α)."""

    dh: tuple[DhRow, DhRow, DhRow, DhRow, DhRow, DhRow] = key('standard Denavit–Hartenberg table')
    home_deg: SixAngles = quantity(*TURN_DEG, HOME_ANGLES)
    tool_mm: float = quantity(0, PLACE_MM[1], 'to the tool along z of frame 6', default=0.0)

    def chain(self) -> Chain:
        """Joint i turns about the z axis of frame i − 1; the tool lies along z of frame 6."""
        frame = np.eye(4)
        axes, points = [], []
        for row in self.dh:
            axes.append(frame[:3, 2])
            points.append(frame[:3, 3])
            frame = frame @ _link(row)
        tool = frame[:3, 3] + self.tool_mm * 1e-3 * frame[:3, 2]
        return Chain(np.array(axes), np.array(points), Pose(tool, frame[:3, :3]))


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
    home_deg: SixAngles = quantity(*TURN_DEG, HOME_ANGLES)

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


ArmGeometry = LengthsConfig | DhConfig | ScrewsConfig


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
    usual = float(np.median(links[links > 0.0])) if links.any() else 0.0
    if links[longest] > PROPORTION * usual:
        gap = f'{names[longest + 1]} is {length(links[longest])} from {names[longest]}'
        others = f'the others are about {length(usual)} long'
        raise ConfigError([f'geometry: {gap}, {others}: is it in another unit?'])
    if not SHORTEST_ARM <= links.sum() <= LONGEST_ARM:
        whole = f'all links together are {length(links.sum())}'
        ends = f'{length(SHORTEST_ARM)} to {length(LONGEST_ARM)} fit'
        raise ConfigError([f'geometry: {whole}, {ends}: is it in another unit?'])


def _link(row: DhRow) -> Array:
    theta, alpha = np.radians([row.offset_deg, row.alpha_deg])
    (ct, ca), (st, sa) = np.cos([theta, alpha]), np.sin([theta, alpha])
    a, d = row.a_mm * 1e-3, row.d_mm * 1e-3
    return np.array(
        [
            [ct, -st * ca, st * sa, a * ct],
            [st, ct * ca, -ct * sa, a * st],
            [0.0, sa, ca, d],
            [0.0, 0.0, 0.0, 1.0],
        ]
    )


JOINT_NAMES = tuple(f'joint_{i}' for i in range(1, JOINTS + 1))
OWNERS = tuple(f'joint {i}' for i in range(1, JOINTS + 1))


@dataclass(frozen=True)
class JointConfig:
    """One joint in the units of its machine file."""

    range_deg: tuple[float, float] = quantity(-720, 720, 'travel')
    speed_deg_s: float = quantity(*RATE, 'largest')
    acceleration_deg_s2: float = quantity(*RATE, 'largest')

    def __post_init__(self) -> None:
        """Raises ConfigError for an empty range."""
        low, high = self.range_deg
        if not low < high:
            raise ConfigError([f'range_deg: [{low:g}, {high:g}] is empty'])


@dataclass(frozen=True)
class ArmLimits:
    """The `limits` section of a serial arm's machine file.

    damping_onset is the singular value below which a posture counts as near to singular, with
    metres divided by characteristic_length_mm (docs/arm-kinematics.md, 8).
    """

    joints: tuple[JointConfig, JointConfig, JointConfig, JointConfig, JointConfig, JointConfig] = (
        key('base first')
    )
    characteristic_length_mm: float = quantity(
        *SIZE_MM, 'what one radian counts: about half the reach'
    )
    damping_onset: float = quantity(
        0.001, 0.5, 'singular value from which a posture is near to singular'
    )

    def joint_limits(self) -> 'JointLimits':
        """In radians."""
        ranges = np.radians([joint.range_deg for joint in self.joints])
        return JointLimits(
            ranges[:, 0],
            ranges[:, 1],
            np.radians([joint.speed_deg_s for joint in self.joints]),
            np.radians([joint.acceleration_deg_s2 for joint in self.joints]),
        )


@dataclass(frozen=True, eq=False)
class JointLimits:
    """Arrays (6,) in rad, rad/s and rad/s²."""

    low: Array
    high: Array
    speed: Array
    acceleration: Array

    def __post_init__(self) -> None:
        """Freezes the arrays."""
        for name in ('low', 'high', 'speed', 'acceleration'):
            object.__setattr__(self, name, frozen(getattr(self, name)))

    def constraints(self) -> Constraints:
        """The joint ranges alone: a serial arm may stand in a singular posture."""
        return Constraints((JointRange(self.low, self.high, OWNERS),))
