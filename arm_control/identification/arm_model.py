"""The parameters of a serial arm: where its six joints are zero, and how its links are built."""

from dataclasses import dataclass, field

import numpy as np

from arm_control.arm import SerialArm
from arm_control.chain import Chain
from arm_control.identification.link_errors import LinkError, link_errors
from manipulator.arrays import Array
from manipulator.identification.model import Parameter
from manipulator.pose import Pose

JOINTS = 6
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
