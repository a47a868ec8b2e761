"""The motion supervisor: takes the machine over at its measured joints, and releases it.

The machine is supervised while it is enabled, its pose is received and its joints follow. Whatever
ends that drops every goal; later motion begins where the joints then are.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from manipulator.arrays import Array
from manipulator.errors import Refused
from manipulator.framed_machine import in_frames
from manipulator.frames import Frames
from manipulator.machine import Machine
from manipulator.pose import Pose
from manipulator.trajectory.executor import Executor
from manipulator.trajectory.following import Arrival, Following, Tolerances
from manipulator.trajectory.motion_status import MotionStatus
from manipulator.trajectory.worker import Worker

HOLDING = 'holding'
DRIVABLE = ('enabled', HOLDING)
"""States in which the board follows setpoints; it holds when they came too late."""

WAYS_OUT = {
    '': 'no bridge says how it is',
    'disconnected': 'no board answers',
    'booting': 'its board is not there yet',
    'arming': 'its servos are being switched on',
    'playing': 'its board plays a program of its own',
    'stopped': 'clear the stop first',
    'fault': 'clear the fault first',
}
"""What is missing before anybody may drive, by the bridge's word."""

POSE_PATIENCE, POSE_DEADLINE = 0.2, 0.5
"""Seconds without a pose after which motion pauses, and after which it is dropped."""

STATE_DEADLINE = 1.5
"""Seconds without the bridge's word after which its last one counts for nothing."""

PRESENT = 0.1
"""Of the tolerance of following, how far the joints may be from the pose where motion begins."""

MISFITS = 50
"""Poses in a row that do not fit the joints before that is said: some are only late."""

RESULTS = ('reached', 'refused', 'stopped')
"""What became of a goal: still reported where a machine that held is taken over again at once."""

DISABLED = MotionStatus('disabled', 'idle', 0.0, 'the servos are not enabled')
CONNECTING = MotionStatus('disabled', 'idle', 0.0, 'the board does not follow setpoints yet')


class NotYet(Refused):
    """Nobody may drive yet, but the machine is about to be taken over."""


class MotionSupervisor:
    """One machine's driver; poses that come and go are the platform's, in the base frame."""

    def __init__(
        self,
        machine: Machine,
        dt: float,
        tolerances: Tolerances | None = None,
        worker: Worker | None = None,
    ) -> None:
        """tolerances: by default by the joints' ranges; worker: where plans are worked out."""
        self.status = DISABLED
        self.machine = in_frames(machine, machine.frames)
        self._bare = machine
        self._dt = dt
        self._tolerances = tolerances or Tolerances.of(machine)
        self._worker = worker
        self._executor: Executor | None = None
        self._following: Following | None = None
        self._state = ''
        self._is_followed = False
        self._is_measured = False
        self._joints: Array | None = None
        self._pose: Pose | None = None
        self._arrival = Arrival(dt)
        self._misfits = 0
        self._misfit = ''
        self._override = 1.0
        self._is_paused = False
        self._next_frames: Frames | None = None

    @property
    def executor(self) -> Executor:
        """What takes commands; Refused while nobody may drive, NotYet where that soon ends."""
        if self._executor is None:
            is_soon = self._state in DRIVABLE and not self._misfit
            kind = NotYet if is_soon else Refused
            raise kind(f'the machine is {self._state or "not heard of"}: {self._missing}')
        if not self._is_followed:
            raise NotYet(CONNECTING.reason)
        return self._executor

    @property
    def _missing(self) -> str:
        if self._state in DRIVABLE:
            return self._misfit or 'its pose is not known yet'
        return WAYS_OUT.get(self._state, 'enable it first')

    @property
    def is_driving(self) -> bool:
        """Whether setpoints go out."""
        return self._executor is not None

    @property
    def is_measured(self) -> bool:
        """Whether poses tell where the joints are, and not only where they were sent."""
        return self._is_measured

    def note_machine_state(self, state: str, is_followed: bool, is_measured: bool = False) -> None:
        """What the bridge says: its word, whether the board follows setpoints and measures."""
        self._is_measured = is_measured
        is_lost = state not in DRIVABLE or (state == HOLDING and state != self._state)
        is_new = state in DRIVABLE and self._state not in DRIVABLE
        was_followed, self._state, self._is_followed = self._is_followed, state, is_followed
        if is_lost:
            self._forget_misfit()
            self.release(f'the machine is {state}')
        elif self._executor is None and is_new:
            self.status = DISABLED
        elif self._executor is not None and is_followed and not was_followed:
            self.status = self._executor.status

    def note_joints(self, joints: Array) -> None:
        """Where the joints are: on their branch the machine is taken over; they must follow."""
        self._joints = joints
        if self._following is not None:
            self._following.measure(joints)

    def note_pose(self, T_base_platform: Pose) -> None:
        """Where the platform is: there a machine that may be driven is taken over."""
        self._pose = T_base_platform
        if self._executor is not None:
            if self._is_measured:
                self._executor.note_measured(self.machine.frames.pivot(T_base_platform))
            return
        if self._joints is None or self._state not in DRIVABLE:
            return
        gaps = self._gaps(T_base_platform, self._joints)
        if (gaps < PRESENT * self._tolerances.following).all():
            self._take_over(T_base_platform, self._joints)
        else:
            self._note_misfit(gaps)

    def note_silence(self, seconds: float) -> None:
        """How long no pose was heard: soon the plan brakes on its way, later it is dropped."""
        if seconds > POSE_DEADLINE:
            self.release(f'no pose for {POSE_DEADLINE:g} s')
        elif self._executor is not None:
            self._executor.blind(seconds > POSE_PATIENCE)

    def note_bridge_silence(self, seconds: float) -> None:
        """How long the bridge has not said the machine's state: a dead one's must not be used."""
        if seconds > STATE_DEADLINE and self._state:
            self._state, self._is_followed = '', False
            self._forget_misfit()
            self.release(f'no word of the bridge for {STATE_DEADLINE:g} s')

    def note_stall(self, seconds: float) -> None:
        """How long the caller itself stood still: by then the board holds, and goals are old."""
        if seconds > POSE_DEADLINE:
            self.release(f'setpoints stood still for {seconds:.1f} s')

    def release(self, reason: str) -> None:
        """Lets go of the machine: no setpoints until its pose is known again."""
        if self._executor is not None:
            stamp = self._executor.newest_stamp
            self._executor.close()
            self._executor = self._following = None
            self.status = MotionStatus('disabled', 'stopped', stamp, reason)

    def override(self, rate: float) -> None:
        """Scales all motion, now and later; Refused outside [0, 1]."""
        if not 0.0 <= rate <= 1.0:
            raise Refused(f'speed override {rate:g} outside [0, 1]')
        self._override = rate
        if self._executor is not None:
            self._executor.override(rate)

    def pause(self, is_paused: bool) -> None:
        """Holds all motion up, or lets it go on; Refused while nobody may drive.

        A machine that is lost while paused is paused when it is taken over again.
        """
        self.executor.pause(is_paused)
        self._is_paused = is_paused

    def set_pivot(self, point: Sequence[float]) -> None:
        """Another pivot (platform frame, m), taken once the machine stands still."""
        self._next_frames = self.machine.frames.with_pivot(point)

    def step(self) -> Pose | None:
        """Advances by one tick: the pose to command, None while nobody drives."""
        if self._next_frames is not None and self._is_settled:
            self._take_frames(self._next_frames)
        if self._following is not None and self._following.trouble:
            self.release(self._following.trouble)
        if self._executor is None or self._following is None:
            return None
        pose = self._executor.step()
        self._following.command(self._executor.joints)
        if self._is_followed:
            missing = self._following.missing(self._is_measured)
            words = f'{missing}{self._distance_words()}' if missing else ''
            self.status = self._arrival.judged(self._executor.status, words) or self.status
        return self.machine.frames.platform(pose)

    @property
    def _is_settled(self) -> bool:
        """Whether nothing moves, and what became of the last goal has been reported."""
        if self._executor is None:
            return True
        status = self._executor.status
        is_awaited = self._is_followed and status.result == 'reached'
        return self._executor.is_at_rest and (self._arrival.has_judged(status) or not is_awaited)

    def _distance_words(self) -> str:
        """How far the measured platform or tool is from the commanded pose."""
        if not self._is_measured or self._pose is None or self._executor is None:
            return ''
        commanded = self.machine.frames.platform(self._executor.state.pose)
        way = commanded.twist_to(self._pose)
        shift, turn = (float(np.linalg.norm(part)) for part in (way[:3], way[3:]))
        return f': the goal is missed by {1e3 * shift:.3g} mm and {np.degrees(turn):.2g}°'

    def _take_over(self, T_base_platform: Pose, near: Array) -> None:
        self._forget_misfit()
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
        self._following = Following(
            kinematics.joint_names, kinematics.joint_unit, self._tolerances, self._dt
        )
        self._arrival = Arrival(self._dt)
        self.status = executor.status if self._is_followed else CONNECTING

    def _gaps(self, T_base_platform: Pose, joints: Array) -> Array:
        """How far each joint is from a pose, which may be late: from where the joints were."""
        gaps: Array = np.abs(self._bare.kinematics.inverse(T_base_platform, joints) - joints)
        return gaps

    def _note_misfit(self, gaps: Array) -> None:
        """Says which joint keeps the machine from being taken over, once that lasts.

        So it is where a leg is bent the wrong way and nearly straight: no motion begins there.
        """
        self._misfits += 1
        if self._misfits == MISFITS:
            worst = int(np.argmax(gaps))
            kinematics = self._bare.kinematics
            self._misfit = (
                f'its pose does not fit {kinematics.joint_names[worst]}, which is off by '
                f'{gaps[worst]:.2g} {kinematics.joint_unit}: disable and enable it, it then parks'
            )
            self.status = MotionStatus('disabled', 'idle', self.status.goal_stamp, self._misfit)

    def _forget_misfit(self) -> None:
        if self._misfit:
            self.status = DISABLED
        self._misfits, self._misfit = 0, ''

    def _take_frames(self, frames: Frames) -> None:
        old, self.machine = self.machine, in_frames(self._bare, frames)
        self._next_frames = None
        before = self._executor
        if before is not None:
            pose = old.frames.platform(before.state.pose)
            self._take_over(pose, before.joints)
