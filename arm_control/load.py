"""From a machine file to a serial arm that the nodes can use, with its `Jogger`."""

from dataclasses import dataclass, field, replace
from functools import partial

import numpy as np

from arm_control.arm import SerialArm
from arm_control.bodies import arm_bodies
from arm_control.geometry import ArmGeometry, check_axes, placed
from arm_control.joint_limits import ArmLimits
from arm_control.rate_scaling import AT_ONCE
from arm_control.resolved_rate import JogState, ResolvedRate
from manipulator.arrays import Array, frozen
from manipulator.config import build
from manipulator.errors import ConfigError
from manipulator.formatting import shown
from manipulator.frames import Frames
from manipulator.limits.constraints import Constraints
from manipulator.limits.limit import LimitOf
from manipulator.limits.machine_limits import JointRange
from manipulator.machine import Kind, Machine, MachineFile
from manipulator.motion_limits import MotionLimits
from manipulator.pose import Pose
from manipulator.teleop.jogger import STRAIGHT, JogMotion, ticks_for, towards

SHARE_BEFORE_STOPS = 0.5
"""Of the tool's acceleration, what braking before a stop counts on; the rest is for bends: a joint
may turn ever faster while the tool goes straight on."""
ROUNDING = 1e-6
"""Part of a tick's change of twist."""
STILL, LONG = 1e-9, 1e6
"""Rates of a value (m/s or rad/s) that count as none; seconds that are no bound."""
LAG = 0.02
"""Of a tick's change of twist, by which a tool that is pulled back on its line may pass it."""


@dataclass(frozen=True, eq=False)
class ArmJogger:
    """`Jogger` of an arm: see `ResolvedRate` for what it follows and keeps.

    The requested twist continues from motion.along, the part of it that the joints could follow,
    or from motion.twist where the tool would otherwise pass its accelerations. of_pose are the
    limits in task space, for poses of the pivot.
    """

    jog: ResolvedRate
    frames: Frames
    of_pose: Constraints = field(default_factory=lambda: Constraints(()))

    def step(self, motion: JogMotion, twist: Array, dt: float) -> JogMotion:
        """See `Jogger`; in a corner of the joint ranges the tool slides, so as to get out."""
        if not self.of_pose.limits:
            return self._within_joints(motion, twist, dt)
        part, name = (1.0, '')
        if twist.any():
            part, name = self._part_before_limits(motion, twist, dt)
        after = self._within_joints(motion, part * twist, dt)
        passed = self._passed(motion, after)
        if passed:
            still = JogMotion.at_rest(motion.pose, motion.joints)
            return replace(still, scale=0.0, held_by=passed)
        return replace(after, scale=part * after.scale, held_by=name or after.held_by)

    def _passed(self, before: JogMotion, after: JogMotion) -> str:
        """Beyond which limit a step leads, that braking in time could not foresee; or ''."""
        out = self._excess(after)
        if not out.any():
            return ''
        further = out - self._excess(before)
        worst = int(np.argmax(further))
        return self._name(worst) if further[worst] > STILL else ''

    def _name(self, index: int) -> str:
        quantity, owner, _ = self.of_pose.names[index]
        return quantity or owner

    def _excess(self, motion: JogMotion) -> Array:
        """How far (k,) the limited values are beyond their limits, 0 inside."""
        limits, values = self.of_pose, self.of_pose.values(motion.pose, motion.joints)
        return np.maximum(np.maximum(limits.low - values, values - limits.high), 0.0)

    def _part_before_limits(self, motion: JogMotion, twist: Array, dt: float) -> tuple[float, str]:
        """The part of a twist from which the tool can brake in time, and which limit bounds it.

        By the rates of the limited values, which change little while it brakes.
        """
        limits, joints = self.of_pose, motion.joints
        ahead = joints + dt * self._joint_rates(motion, twist)
        poses = motion.pose.moved(np.outer([0.0, dt], twist))
        here, there = limits.values(poses, np.array([joints, ahead]))
        rate = (there - here) / dt
        is_rising, is_falling = rate > STILL, rate < -STILL
        left = np.where(
            is_rising, limits.high - here, np.where(is_falling, here - limits.low, np.inf)
        )
        time = np.maximum(left, 0.0) / np.maximum(np.abs(rate), STILL)
        braking = float(ticks_for(twist, self.jog.motion, dt)) * dt / SHARE_BEFORE_STOPS
        parts = 2.0 * time / (dt + np.sqrt(dt**2 + 2.0 * braking * np.minimum(time, LONG)))
        worst = int(np.argmin(parts))
        return (float(parts[worst]), self._name(worst)) if parts[worst] < 1.0 else (1.0, '')

    def _joint_rates(self, motion: JogMotion, twist: Array) -> Array:
        """Those (6,) of a twist of the pivot, damped in singular postures."""
        return self.jog.damped_rates(motion.joints, self._of_tool(twist, motion.pose))

    def _within_joints(self, motion: JogMotion, twist: Array, dt: float) -> JogMotion:
        """The step, with no limits but those of the joints."""
        limits = self.jog.motion
        requested = towards(motion.along, twist, limits, dt)
        ticks = ticks_for(requested, limits, dt)
        if ticks_for(requested - motion.twist, limits, dt) > 1.0 + LAG:
            requested = towards(motion.twist, twist, limits, dt)
        slowing = SHARE_BEFORE_STOPS / (max(ticks, 1.0) * dt)
        after = self._stepped(motion, requested, dt, slowing)
        along = ticks_for(after.along - motion.along, limits, dt)
        if along > 1.0 + ROUNDING or ticks_for(after.twist - motion.twist, limits, dt) > 1.0 + LAG:
            # No part of the request can be reached as gently as the tool asks for.
            straight = towards(motion.twist, np.zeros(6), limits, dt)
            line = replace(motion.line, off_line=STRAIGHT)
            braked = self._stepped(replace(motion, line=line), straight, dt)
            return replace(braked, scale=after.scale, held_by=after.held_by)
        return after

    def _stepped(
        self, motion: JogMotion, requested: Array, dt: float, slowing: float = AT_ONCE
    ) -> JogMotion:
        before = JogState(motion.joints, motion.rates, motion.line)
        step = self.jog.step(before, self._of_tool(requested, motion.pose), dt, slowing)
        state, along = step.state, step.driven * requested
        along.setflags(write=False)
        return JogMotion(
            self.frames.pivot(self.jog.arm.chain.forward(state.joints)),
            state.joints,
            self._of_pivot(step.twist, motion.pose),
            state.rates,
            step.scale,
            step.held_by,
            state.line,
            along,
        )

    def _of_tool(self, twist: Array, T_work_pivot: Pose) -> Array:
        """The tool's twist in base axes, for the pivot's in work axes: v − ω × r."""
        if self.frames.are_plain:
            return twist
        to_base = self.frames.T_base_work.rotation
        turn = to_base @ twist[3:]
        arm = to_base @ T_work_pivot.rotation @ self.frames.arm
        return np.concatenate([to_base @ twist[:3] - np.cross(turn, arm), turn])

    def _of_pivot(self, twist: Array, T_work_pivot: Pose) -> Array:
        """The inverse: the pivot's twist in work axes, for the tool's in base axes."""
        if self.frames.are_plain:
            return twist
        to_work = self.frames.T_base_work.rotation.T
        turn = to_work @ twist[3:]
        arm = T_work_pivot.rotation @ self.frames.arm
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
        make_bodies=partial(arm_bodies, jog.arm),
    )


def _jogger(jog: ResolvedRate, machine: Machine) -> ArmJogger:
    slides = machine.jog_singularity == 'slide'
    of_pose = [
        limit
        for limit in machine.constraints.limits
        if not isinstance(limit.inner if isinstance(limit, LimitOf) else limit, JointRange)
    ]
    jog = replace(jog, slides=slides)
    return ArmJogger(jog, machine.frames, Constraints(tuple(of_pose)))


def serial_arm(machine_file: MachineFile) -> SerialArm:
    """The kinematics and joint limits of one file."""
    if machine_file.kind != KIND:
        raise ConfigError([f'kind: {shown(machine_file.kind)} is not {KIND!r}'])
    return KINDS[KIND].build(machine_file)


def _serial_arm(geometry: ArmGeometry, limits: ArmLimits) -> SerialArm:
    length = limits.characteristic_length_mm * 1e-3
    rest = np.radians(geometry.home_deg)
    return SerialArm(placed(geometry.chain()), limits.joint_limits(), length, rest)


KINDS = {KIND: Kind(ArmGeometry, ArmLimits, _serial_arm, check_axes)}


def jogging(machine_file: MachineFile) -> ResolvedRate:
    """The resolved-rate step of one file's arm, within its joint and motion limits."""
    kinematics = serial_arm(machine_file)
    limits = build(ArmLimits, machine_file.limits, 'limits')
    motion = MotionLimits.from_config(machine_file.motion, kinematics.joint_unit)
    own = kinematics.limits
    motion = replace(motion, joint=motion.joint.tightened(own.speed, own.acceleration))
    return ResolvedRate(kinematics, motion, limits.damping_onset)
