"""The parameters of a serial arm: where its joints are zero, how its links are built.

A line has four freedoms beside another one. The first is the joint's zero angle; the other three
are, as in the tables of Denavit and Hartenberg, a shift along the joint's axis (offset), a shift
along the common normal to the next axis (length) and a turn about that normal (twist). Beside a
parallel axis the offset changes nothing and another turn takes its place, about the third
direction (skew; Hayati, IEEE CDC 1983). An identified arm is written as lines of its machine file,
in millimetres and degrees.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from arm_control.arm import SerialArm
from arm_control.chain import JOINTS, Chain
from manipulator.analysis.measurements import Parameter
from manipulator.arrays import Array
from manipulator.pose import Pose
from manipulator.yaml_edit import flow_list

PARALLEL = 1e-3
"""Sine of the angle of two axes below which an offset is no longer told from the next one."""

COAXIAL = 1e-3
"""Metres between parallel axes below which their common normal may point anywhere."""


@dataclass(frozen=True, eq=False)
class LinkError:
    """One freedom of a link, in base axes at zero angles: along or about a line, what is beyond.

    kind is offset, length, twist or skew; direction a unit vector (3,), point (3,) in metres.
    """

    link: int
    kind: str
    direction: Array
    point: Array

    @property
    def is_turn(self) -> bool:
        """Whether its value is in radians, not in metres."""
        return self.kind in ('twist', 'skew')

    def displacement(self, value: float) -> Pose:
        """What it does to all that comes behind the link."""
        if not self.is_turn:
            return Pose(value * self.direction, np.eye(3))
        turn = Pose.identity().moved(np.concatenate([np.zeros(3), value * self.direction]))
        return Pose(self.point - turn.rotation @ self.point, turn.rotation)

    def twist(self, moved: Pose, tool: Array) -> Array:
        """The tool's twist (n, 6) by its unit, with the line moved (n,) and the tool at (n, 3)."""
        direction = moved.rotation @ self.direction
        if not self.is_turn:
            return np.concatenate([direction, np.zeros_like(direction)], axis=-1)
        arm = tool - (moved.rotation @ self.point + moved.position)
        return np.concatenate([np.cross(direction, arm), direction], axis=-1)


def link_errors(chain: Chain) -> tuple[LinkError, ...]:
    """Three of each link between two joints, from the base on."""
    return tuple(error for i in range(len(chain.axes) - 1) for error in _of_link(chain, i))


def _of_link(chain: Chain, i: int) -> Iterator[LinkError]:
    axis, following = chain.axes[i], chain.axes[i + 1]
    point = chain.points[i + 1]
    across = np.cross(axis, following)
    sine = float(np.linalg.norm(across))
    if sine > PARALLEL:
        normal = across / sine
        yield LinkError(i + 1, 'offset', axis, point)
        yield LinkError(i + 1, 'length', normal, point)
        yield LinkError(i + 1, 'twist', normal, point)
        return
    arm = point - chain.points[i]
    arm = arm - (arm @ axis) * axis
    length = float(np.linalg.norm(arm))
    normal = arm / length if length > COAXIAL else _perpendicular(axis)
    yield LinkError(i + 1, 'length', normal, point)
    yield LinkError(i + 1, 'twist', normal, point)
    yield LinkError(i + 1, 'skew', np.cross(axis, normal), point)


AXIS_DIGITS, ANGLE_DIGITS = 8, 6


def geometry_lines(chain: Chain, rest: Array) -> list[str]:
    """The `geometry` section by joint axes, to 0.1 µm; rest (6,) are the joints at home, rad."""
    screws = [
        f'    - {{axis: {flow_list(axis, AXIS_DIGITS)}, point_mm: {flow_list(1e3 * point)}}}'
        for axis, point in zip(chain.axes, chain.points, strict=True)
    ]
    return [
        '  screws:',
        *screws,
        f'  tool_position_mm: {flow_list(1e3 * chain.home.position)}',
        f'  tool_rpy_deg: {flow_list(np.degrees(chain.home.rpy), ANGLE_DIGITS)}',
        f'  home_deg: {flow_list(np.degrees(rest), ANGLE_DIGITS)}',
    ]


def _perpendicular(axis: Array) -> Array:
    """Some unit vector (3,) at a right angle to an axis."""
    across: Array = np.cross(axis, np.eye(3)[np.argmin(np.abs(axis))])
    result: Array = across / np.linalg.norm(across)
    return result


GROUPS = {'offset': 'lengths', 'length': 'lengths', 'twist': 'twists', 'skew': 'twists'}


@dataclass(frozen=True, eq=False)
class ArmModel:
    """See `Model`. Values are six zero angles, then three errors of each of the five links.

    How the arm stands on its base, and the tool on the last joint, is for the frames of the
    measuring device to say. Tolerances in m and rad.
    """

    arm: SerialArm
    length_tolerance: float
    angle_tolerance: float
    errors: tuple[LinkError, ...] = field(init=False)

    def __post_init__(self) -> None:
        """Lays out the links."""
        object.__setattr__(self, 'errors', link_errors(self.arm.chain))

    @property
    def parameters(self) -> tuple[Parameter, ...]:
        """Six zero angles, fifteen of the links: 21."""
        zeros = (
            Parameter(f'joint {i} zero angle', 'zeros', 'rad', self.angle_tolerance)
            for i in range(1, JOINTS + 1)
        )
        return (*zeros, *map(self._parameter, self.errors))

    def predict(self, values: Array, joints: Array, near: Pose) -> Pose:
        """See `Model`; an arm stands in one pose only."""
        return self.identified(values).forward(joints + self.joint_offsets(values))

    def slopes(self, values: Array, joints: Array, poses: Pose) -> Array:
        """See `Model`: of a zero angle what the joint does, of a link what its line would do."""
        chain, turned = self.identified(values), joints + self.joint_offsets(values)
        moved = chain.displacements(turned)
        tool = chain.forward(turned).position
        columns, built = [], Pose.identity()
        for error, value in zip(self.errors, values[JOINTS:], strict=True):
            before = moved[:, error.link]
            place = Pose(before[:, :3, 3], before[:, :3, :3]) @ built
            columns.append(error.twist(place, tool))
            built = built @ error.displacement(float(value))
        return np.concatenate([chain.jacobian(turned), np.stack(columns, axis=-1)], axis=-1)

    def identified(self, values: Array) -> Chain:
        """The chain with these values, but for the zero angles, which are the servos'."""
        nominal = self.arm.chain
        axes, points = nominal.axes.copy(), nominal.points.copy()
        built = Pose.identity()
        for i in range(1, JOINTS):
            for error, value in zip(self.errors, values[JOINTS:], strict=True):
                if error.link == i:
                    built = built @ error.displacement(float(value))
            axes[i] = built.rotation @ axes[i]
            points[i] = built.transform(points[None, i])[0]
        return Chain(axes, points, built @ nominal.home)

    def joint_offsets(self, values: Array) -> Array:
        """(6,): true angle less the commanded one, rad."""
        return values[:JOINTS]

    def rigid_motions(self, values: Array) -> dict[str, Array]:
        """See `Model`: what moves all of the arm on its base, or the tool alone."""
        every = np.eye(len(self.parameters))
        found = {
            'the zero of joint 1 (the base turned about its axis)': every[0],
            'the zero of joint 6 (the tool turned about its axis)': every[JOINTS - 1],
        }
        if self.errors[0].kind == 'offset':
            found['the offset of link 1 (the base shifted along its axis)'] = every[JOINTS]
        return found

    def _parameter(self, error: LinkError) -> Parameter:
        name = f'link {error.link} {error.kind}'
        if error.is_turn:
            return Parameter(name, GROUPS[error.kind], 'rad', self.angle_tolerance)
        return Parameter(name, GROUPS[error.kind], 'm', self.length_tolerance)
