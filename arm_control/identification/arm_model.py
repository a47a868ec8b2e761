"""The parameters of a serial arm: where its six joints are zero."""

from dataclasses import dataclass

import numpy as np

from arm_control.chain import Chain
from manipulator.arrays import Array
from manipulator.identification.model import Parameter
from manipulator.pose import Pose


@dataclass(frozen=True, eq=False)
class ArmModel:
    """See `Model`. A joint stands at its commanded angle and its zero angle; tolerance in rad."""

    chain: Chain
    tolerance: float

    @property
    def parameters(self) -> tuple[Parameter, ...]:
        """Six zero angles."""
        return tuple(
            Parameter(f'joint {i} zero angle', 'zeros', 'rad', self.tolerance) for i in range(1, 7)
        )

    def predict(self, values: Array, joints: Array, near: Pose) -> Pose:
        """See `Model`; an arm stands in one pose only."""
        return self.chain.forward(joints + self.joint_offsets(values))

    def slopes(self, values: Array, joints: Array, poses: Pose) -> Array:
        """See `Model`."""
        return self.chain.jacobian(joints + self.joint_offsets(values))

    def joint_offsets(self, values: Array) -> Array:
        """(6,): true angle less the commanded one, rad."""
        return values

    def rigid_motions(self, values: Array) -> dict[str, Array]:
        """See `Model`: the first joint turns all of the arm, the last one the tool alone."""
        return {
            'the zero of joint 1 (the base turned about its axis)': np.eye(6)[0],
            'the zero of joint 6 (the tool turned about its axis)': np.eye(6)[-1],
        }
