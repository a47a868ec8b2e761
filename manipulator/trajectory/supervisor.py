"""The motion supervisor: takes the machine over at its measured joints, and releases it.

The machine is supervised while it is enabled, its pose is received and its joints follow. Whatever
ends that drops every goal; later motion begins where the joints then are.
"""

from collections.abc import Sequence
from dataclasses import replace

from manipulator.arrays import Array
from manipulator.deadlines import POSE_DEADLINE, POSE_PAUSE, STATE_DEADLINE
from manipulator.errors import Refused
from manipulator.framed_machine import in_frames
from manipulator.frames import Frames
from manipulator.machine import Machine
from manipulator.planning.worker import Worker
from manipulator.pose import Pose
from manipulator.states import MachineState, MotionMode, MotionResult
from manipulator.static_deflection import joints_under
from manipulator.trajectory.active_plan import ActivePlan
from manipulator.trajectory.closed_loop import ClosedLoop
from manipulator.trajectory.executor import Executor
from manipulator.trajectory.following_error import (
    Arrival,
    FollowingError,
    PoseMatch,
    Tolerances,
    dead_band_of,
    missed,
)
from manipulator.trajectory.motion_status import MotionStatus
from manipulator.unit_hints import check_pivot

DRIVABLE = (MachineState.ENABLED, MachineState.HOLDING)
"""Machine states in which the board follows setpoints; it holds after its deadline."""

REMEDIES = {
    '': 'no machine_state received from serial_bridge',
    MachineState.DISCONNECTED: 'the board does not answer',
    MachineState.BOOTING: 'its board is still booting',
    MachineState.ARMING: 'its servos are being switched on',
    MachineState.PLAYING: 'its board plays a program of its own',
    MachineState.STOPPED: 'clear the stop first',
    MachineState.FAULT: 'clear the fault first',
}
"""What is missing before the machine can be driven, by machine state."""

MEASUREMENT_DELAY = 0.06
"""Seconds from a measured pose to the moment that its correction moves the joints, by default."""

RESULTS = (MotionResult.REACHED, MotionResult.REFUSED, MotionResult.STOPPED)
"""Results of goals: still reported where a machine that held is taken over again at once."""

DISABLED = MotionStatus(MotionMode.DISABLED, MotionResult.IDLE, 0.0, 'the servos are not enabled')
CONNECTING = MotionStatus(
    MotionMode.DISABLED, MotionResult.IDLE, 0.0, 'the board does not follow setpoints yet'
)


class NotYet(Refused):
    """The machine cannot be driven yet, but is about to be taken over."""


class MotionSupervisor:
    """One machine's; poses in arguments and results are the platform's, in the base frame."""

    def __init__(
        self,
        machine: Machine,
        dt: float,
        tolerances: Tolerances | None = None,
        worker: Worker | None = None,
        delay: float = MEASUREMENT_DELAY,
    ) -> None:
        """tolerances: by default by the joints' ranges; worker: where plans are made.

        delay: seconds from a measurement to the moment that its correction moves the joints.
        """
        self.status = DISABLED
        self.machine = in_frames(machine, machine.frames)
        self._bare = machine
        self._dt = dt
        self._tolerances = tolerances or Tolerances.of(machine)
        self._worker = worker
        self._delay = delay
        self._dead_band = dead_band_of(machine)
        self._loop: ClosedLoop | None = None
        self._executor: Executor | None = None
        self._following_error: FollowingError | None = None
        self._state = ''
        self._is_followed = False
        self._is_measured = False
        self._joints: Array | None = None
        self._pose: Pose | None = None
        self._arrival = Arrival(dt, delay)
        self._match = PoseMatch(machine, self._tolerances.following)
        self._override = 1.0
        self._is_paused = False
        self._next_frames: Frames | None = None

    @property
    def executor(self) -> Executor:
        """Takes commands; Refused while the machine cannot be driven, NotYet where it soon can."""
        if self._executor is None:
            is_soon = self._state in DRIVABLE and not self._match.reason
            kind = NotYet if is_soon else Refused
            raise kind(f'the machine is {self._state or "unknown"}: {self._missing}')
        if not self._is_followed:
            raise NotYet(CONNECTING.reason)
        return self._executor

    @property
    def _missing(self) -> str:
        if self._state in DRIVABLE:
            return self._match.reason or 'its pose is not known yet'
        return REMEDIES.get(self._state, 'enable it first')

    @property
    def is_driving(self) -> bool:
        """Whether setpoints go out."""
        return self._executor is not None

    @property
    def state(self) -> str:
        """The machine state that was reported last, '' before the first and once it timed out."""
        return self._state

    @property
    def requested_joints(self) -> Array | None:
        """The joints (n,) of a motion of joints, None for motions of poses."""
        return None if self._executor is None else self._executor.own_joints

    @property
    def reported_joints(self) -> Array | None:
        """The joints (n,) that were reported last, without the drives' deflection."""
        return self._joints

    def executed(self, stamp: float) -> ActivePlan | None:
        """The plan that is executed for the goal of that stamp, None where it is not."""
        active = None if self._executor is None else self._executor.active
        return active if active is not None and active.stamp == stamp else None

    @property
    def is_measured(self) -> bool:
        """Whether poses come from measured joints, not from commanded ones."""
        return self._is_measured

    def note_machine_state(self, state: str, is_followed: bool, is_measured: bool = False) -> None:
        """The reported machine state; whether the board follows setpoints, and measures."""
        self._is_measured = is_measured
        is_lost = state not in DRIVABLE or (state == MachineState.HOLDING and state != self._state)
        is_new = state in DRIVABLE and self._state not in DRIVABLE
        was_followed, self._state, self._is_followed = self._is_followed, state, is_followed
        if is_lost:
            self._clear_mismatch()
            self.release(f'the machine is {state}')
        elif self._executor is None and is_new:
            self.status = DISABLED
        elif self._executor is not None and is_followed and not was_followed:
            self.status = self._executor.status

    def note_joints(self, joints: Array) -> None:
        """The reported joints (n,): they select the branch at takeover, and must follow.

        Where they are commands, the drives' deflection at the last pose is subtracted.
        """
        if self._pose is not None:
            joints = joints_under(self._bare.deflection, self._pose, joints)
        self._joints = joints
        if self._following_error is None:
            return
        self._following_error.measure(joints)
        if self._is_measured:
            self._loop = self._loop or ClosedLoop(
                self._dead_band, self._tolerances, self._delay, self._dt
            )
            self._loop.measure(joints)

    def note_pose(self, T_base_platform: Pose) -> None:
        """The reported pose: a machine that can be driven is taken over there."""
        self._pose = T_base_platform
        if self._executor is not None:
            if self._is_measured:
                self._executor.note_measured(self.machine.frames.pivot(T_base_platform))
            return
        if self._joints is None or self._state not in DRIVABLE:
            return
        if self._match.fits(T_base_platform, self._joints):
            self._take_over(T_base_platform, self._joints)
        elif self._match.reason:
            stamp, reason = self.status.goal_stamp, self._match.reason
            self.status = MotionStatus(MotionMode.DISABLED, MotionResult.IDLE, stamp, reason)

    def note_silence(self, seconds: float) -> None:
        """Seconds without a pose: first the plan brakes on its path, later it is dropped."""
        if seconds > POSE_DEADLINE:
            self.release(f'no pose received for {POSE_DEADLINE:g} s')
        elif self._executor is not None:
            self._executor.blind(seconds > POSE_PAUSE)

    def note_bridge_silence(self, seconds: float) -> None:
        """Seconds without a machine state: that of a dead bridge must not be used."""
        if seconds > STATE_DEADLINE and self._state:
            self._state, self._is_followed = '', False
            self._clear_mismatch()
            self.release(f'machine_state timed out ({STATE_DEADLINE:g} s)')

    def note_stall(self, seconds: float) -> None:
        """Seconds for which the caller stalled: by then the board holds, and goals are stale."""
        if seconds > POSE_DEADLINE:
            self.release(f'the control loop stalled for {seconds:.1f} s')

    def release(self, reason: str) -> None:
        """Releases the machine: no setpoints until its pose is known again."""
        if self._executor is not None:
            stamp = self._executor.newest_stamp
            self._executor.close()
            self._executor = self._following_error = self._loop = None
            self.status = MotionStatus(MotionMode.DISABLED, MotionResult.STOPPED, stamp, reason)

    def override(self, rate: float) -> None:
        """Scales all motion, now and later; Refused outside [0, 1]."""
        if not 0.0 <= rate <= 1.0:
            raise Refused(f'speed override {rate:g} outside [0, 1]')
        self._override = rate
        if self._executor is not None:
            self._executor.override(rate)

    def pause(self, is_paused: bool) -> None:
        """Pauses all motion, or continues it; Refused while the machine cannot be driven.

        A machine that is lost while paused is paused when it is taken over again.
        """
        self.executor.pause(is_paused)
        self._is_paused = is_paused

    def set_pivot(self, point: Sequence[float]) -> None:
        """Another pivot (platform frame, m), used once the machine is at rest.

        InvalidInput where it is far from the machine.
        """
        frames = self.machine.frames.with_pivot(point)
        check_pivot(self.machine.kinematics, frames.T_platform_pivot)
        self._next_frames = frames

    def use_tool(self, name: str) -> None:
        """Another tool of the machine file, used once at rest; InvalidInput where it has none."""
        self._next_frames = self.machine.frames.with_tool(name)

    def step(self) -> Pose | None:
        """Advances by one tick: the pose to command, None while not driving."""
        if self._next_frames is not None and self._is_settled:
            self._take_frames(self._next_frames)
        if self._following_error is not None and self._following_error.violation:
            self.release(self._following_error.violation)
        if self._executor is None or self._following_error is None:
            return None
        executor, pose = self._executor, self._executor.step()
        self._following_error.command(executor.joints)
        deviation = ''
        if self._is_followed:
            deviation = self._deviation(executor, self._following_error)
            self.status = self._arrival.judged(executor.status, deviation) or self.status
        if self._loop is not None:
            self._loop.prepare(executor, deviation)
            pose = self._loop.step(self.machine, executor, pose, self._is_correcting(executor))
        return self.machine.frames.platform(pose)

    def _is_correcting(self, executor: Executor) -> bool:
        """Whether a plan is executed, or its end not yet reached, by measured joints."""
        is_over = executor.is_at_rest and self._arrival.has_judged(executor.status)
        return self._is_measured and executor.is_executing and not is_over

    @property
    def _is_settled(self) -> bool:
        """Whether nothing moves, and the result of the last goal has been reported."""
        if self._executor is None:
            return True
        status = self._executor.status
        is_awaited = self._is_followed and status.result == MotionResult.REACHED
        return self._executor.is_at_rest and (self._arrival.has_judged(status) or not is_awaited)

    def _deviation(self, executor: Executor, following: FollowingError) -> str:
        """How far the machine is from the commanded pose, in words; '' within tolerance."""
        joint = following.deviation
        if not self._is_measured or self._pose is None:
            return joint
        gap = executor.state.pose.twist_to(self.machine.frames.pivot(self._pose))
        if joint:
            return f'{joint}: {missed(gap)}'
        return '' if following.is_closest else self._tolerances.violation(gap)

    def _take_over(self, T_base_platform: Pose, near: Array) -> None:
        self._clear_mismatch()
        pose = self.machine.frames.pivot(T_base_platform)
        joints = self.machine.kinematics.inverse(pose, near)
        if self._executor is not None:
            self._executor.close()
        executor = self._executor = Executor(self.machine, pose, joints, self._dt, self._worker)
        executor.override(self._override)
        executor.pause(self._is_paused)
        if self.status.result in RESULTS:
            executor.status = replace(self.status, mode=executor.status.mode)
        kinematics = self.machine.kinematics
        self._following_error = FollowingError(
            kinematics.joint_names, kinematics.joint_unit, self._tolerances, self._dt
        )
        self._arrival = Arrival(self._dt, self._delay)
        self.status = executor.status if self._is_followed else CONNECTING

    def _clear_mismatch(self) -> None:
        if self._match.reason:
            self.status = DISABLED
        self._match.clear()

    def _take_frames(self, frames: Frames) -> None:
        old, self.machine = self.machine, in_frames(self._bare, frames)
        self._next_frames = None
        before = self._executor
        if before is not None:
            pose = old.frames.platform(before.state.pose)
            self._take_over(pose, before.joints)
