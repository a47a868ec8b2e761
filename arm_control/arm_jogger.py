"""The resolved-rate step as the `Jogger` of a serial arm, in the user's frames."""

from dataclasses import dataclass

import numpy as np

from arm_control.resolved_rate import JogState, ResolvedRate
from manipulator.arrays import Array, frozen
from manipulator.frames import Frames
from manipulator.pose import Pose
from manipulator.teleop.jogger import JogMotion
from manipulator.teleop.speed_limits import towards


@dataclass(frozen=True, eq=False)
class ArmJogger:
    """`Jogger` of an arm: what it follows and keeps is said in `ResolvedRate`.

    motion.twist is the wanted twist on its way up or down within the tool's accelerations. Where
    the joints allow only a part of it, it starts again from that part.
    """

    jog: ResolvedRate
    frames: Frames

    def step(self, motion: JogMotion, twist: Array, dt: float) -> JogMotion:
        """See `Jogger`; in a corner of the joint ranges the direction bends, so as to get out."""
        wanted = towards(motion.twist, twist, self.jog.motion, dt)
        state = JogState(motion.joints, motion.rates)
        step = self.jog.step(state, self._of_tool(wanted, motion.pose), dt)
        pose = self.frames.pivot(self.jog.arm.chain.forward(step.state.joints))
        driven = frozen(step.scale * wanted)
        return JogMotion(
            pose, step.state.joints, driven, step.state.rates, step.scale, step.held_by
        )

    def _of_tool(self, twist: Array, T_work_pivot: Pose) -> Array:
        """The tool's twist in base axes, for the pivot's in work axes: v − ω × r."""
        if self.frames.are_plain:
            return twist
        to_base = self.frames.T_base_work.rotation
        turn = to_base @ twist[3:]
        arm = to_base @ T_work_pivot.rotation @ self.frames.T_platform_pivot.position
        return np.concatenate([to_base @ twist[:3] - np.cross(turn, arm), turn])
