"""From a machine file to a serial arm that the nodes can use, with its `Jogger`."""

from dataclasses import dataclass, replace

import numpy as np

from arm_control.arm import SerialArm
from arm_control.geometry import ArmGeometry, ArmLimits, placed
from arm_control.rate_scaling import AT_ONCE
from arm_control.resolved_rate import STRAIGHT, JogState, ResolvedRate
from manipulator.arrays import Array, frozen
from manipulator.config import build
from manipulator.errors import ConfigError
from manipulator.formatting import shown
from manipulator.frames import Frames
from manipulator.machine import Kind, Machine, MachineFile
from manipulator.motion_limits import MotionLimits
from manipulator.pose import Pose
from manipulator.teleop.jogger import JogMotion, ticks_for, towards

SHARE_BEFORE_STOPS = 0.5
"""Of the tool's acceleration, what braking before a stop counts on; the rest is for bends: a joint
may turn ever faster while the tool goes straight on."""
ROUNDING = 1e-6
"""Part of a tick's change of twist."""
LAG = 0.02
"""Of a tick's change of twist, by which a tool that is pulled back on its line may pass it."""


@dataclass(frozen=True, eq=False)
class ArmJogger:
    """`Jogger` of an arm: what it follows and keeps is said in `ResolvedRate`.

    The wanted twist goes on from motion.along, the part of it that the joints could follow, or
    from motion.twist where the tool would otherwise pass its accelerations.
    """

    jog: ResolvedRate
    frames: Frames

    def step(self, motion: JogMotion, twist: Array, dt: float) -> JogMotion:
        """See `Jogger`; in a corner of the joint ranges the tool slides, so as to get out."""
        limits = self.jog.motion
        wanted = towards(motion.along, twist, limits, dt)
        change, ticks = ticks_for(np.array((wanted - motion.twist, wanted)), limits, dt).tolist()
        if change > 1.0 + LAG:
            wanted = towards(motion.twist, twist, limits, dt)
        slowing = SHARE_BEFORE_STOPS / (max(ticks, 1.0) * dt)
        after = self._stepped(motion, wanted, dt, slowing)
        changes = np.array((after.along - motion.along, after.twist - motion.twist))
        along, whole = ticks_for(changes, limits, dt).tolist()
        if along > 1.0 + ROUNDING or whole > 1.0 + LAG:
            # No part of what is wanted can be reached as gently as the tool asks for.
            straight = towards(motion.twist, np.zeros(6), limits, dt)
            braked = self._stepped(replace(motion, off_line=STRAIGHT), straight, dt)
            return replace(braked, scale=after.scale, held_by=after.held_by)
        return after

    def _stepped(
        self, motion: JogMotion, wanted: Array, dt: float, slowing: float = AT_ONCE
    ) -> JogMotion:
        line = motion.off_line, motion.is_leaving, motion.is_under_way
        before = JogState(motion.joints, motion.rates, *line)
        step = self.jog.step(before, self._of_tool(wanted, motion.pose), dt, slowing)
        state = step.state
        return JogMotion(
            self.frames.pivot(self.jog.arm.chain.forward(state.joints)),
            state.joints,
            self._of_pivot(step.twist, motion.pose),
            state.rates,
            step.scale,
            step.held_by,
            state.off_line,
            state.is_leaving,
            state.is_under_way,
            frozen(step.driven * wanted),
        )

    def _of_tool(self, twist: Array, T_work_pivot: Pose) -> Array:
        """The tool's twist in base axes, for the pivot's in work axes: v − ω × r."""
        if self.frames.are_plain:
            return twist
        to_base = self.frames.T_base_work.rotation
        turn = to_base @ twist[3:]
        arm = to_base @ T_work_pivot.rotation @ self.frames.T_platform_pivot.position
        return np.concatenate([to_base @ twist[:3] - np.cross(turn, arm), turn])

    def _of_pivot(self, twist: Array, T_work_pivot: Pose) -> Array:
        """The inverse: the pivot's twist in work axes, for the tool's in base axes."""
        if self.frames.are_plain:
            return twist
        to_work = self.frames.T_base_work.rotation.T
        turn = to_work @ twist[3:]
        arm = T_work_pivot.rotation @ self.frames.T_platform_pivot.position
        return frozen([*(to_work @ twist[:3] + np.cross(turn, arm)), *turn])


KIND = 'serial_arm'


def arm(machine_file: MachineFile) -> Machine:
    """The machine of one file; its kinematics is a `SerialArm`. ConfigError names each fault."""
    jog = jogging(machine_file)
    return Machine(
        jog.arm,
        jog.arm.limits.constraints(),
        jog.motion,
        make_jogger=lambda machine: _jogger(jog, machine),
    )


def _jogger(jog: ResolvedRate, machine: Machine) -> ArmJogger:
    slides = machine.jog_singularity == 'slide'
    return ArmJogger(replace(jog, slides=slides), machine.frames)


def serial_arm(machine_file: MachineFile) -> SerialArm:
    """The kinematics and joint limits of one file."""
    if machine_file.kind != KIND:
        raise ConfigError([f'kind: {shown(machine_file.kind)} is not {KIND!r}'])
    return KINDS[KIND].build(machine_file)


def _serial_arm(geometry: ArmGeometry, limits: ArmLimits) -> SerialArm:
    length = limits.characteristic_length_mm * 1e-3
    rest = np.radians(geometry.home_deg)
    return SerialArm(placed(geometry.chain()), limits.joint_limits(), length, rest)


KINDS = {KIND: Kind(ArmGeometry, ArmLimits, _serial_arm)}


def jogging(machine_file: MachineFile) -> ResolvedRate:
    """The resolved-rate step of one file's arm, within its joint and motion limits."""
    limits = build(ArmLimits, machine_file.limits, 'limits')
    kinematics = serial_arm(machine_file)
    motion = MotionLimits.from_config(machine_file.motion)
    own = kinematics.limits
    motion = replace(motion, joint=motion.joint.tightened(own.speed, own.acceleration))
    return ResolvedRate(kinematics, motion, limits.damping_onset)
