"""An active jog: one source's twists through a jog mode, or its joint rates, within all limits."""

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from manipulator.arrays import Array
from manipulator.errors import Refused
from manipulator.machine import Machine
from manipulator.pose import Pose
from manipulator.teleop.jog_modes import Held, JogMode
from manipulator.teleop.jogger import JogMotion, in_work_axes, towards, within_speed
from manipulator.teleop.joint_jogger import JointJogger, JointMotion

REPORT_INTERVAL = 0.5
"""Seconds between two changes of the reported obstacle."""
NOTABLE = 0.995
"""The part of a request below which the speed limits are reported."""
PAUSED = 'paused, or speed override 0'
STILL = np.zeros(6)


@dataclass(frozen=True, eq=False)
class JogCommand:
    """One jog command: twist (6,) of the pivot in the axes of `frame`."""

    source: str
    twist: Array
    frame: str
    mode: JogMode

    @property
    def takeover(self) -> str:
        """The reason of a motion that it ends."""
        return f'{self.source} took over the machine'

    def begin(self, machine: Machine, pose: Pose, joints: Array, dt: float) -> 'Jog':
        """A jog of this kind."""
        return Jogging(machine, pose, joints, dt)


@dataclass(frozen=True, eq=False)
class JointJogCommand:
    """One jog command of joints: rates (n,) in rad/s or m/s."""

    source: str
    rates: Array

    @property
    def takeover(self) -> str:
        """The reason of a motion that it ends."""
        return f'{self.source} took over the machine'

    def begin(self, machine: Machine, pose: Pose, joints: Array, dt: float) -> 'Jog':
        """A jog of this kind."""
        return JointJogging(machine, pose, joints, dt)


AnyJogCommand = JogCommand | JointJogCommand


class Jog(Protocol):
    """From rest, through one source's commands of one kind, to rest again."""

    is_of_joints: bool

    @property
    def motion(self) -> JogMotion | JointMotion:
        """Where it has come to."""
        ...

    @property
    def reason(self) -> str:
        """What limits it, in words."""
        ...

    def takes(self, command: AnyJogCommand) -> bool:
        """Whether the command is of its kind."""
        ...

    def step(self, request: AnyJogCommand | None, rate: float, measured: Pose | None) -> None:
        """One tick towards the request, at `rate` of its speed; None brakes."""
        ...


class ObstacleReport:
    """What limits a jog, reported on change, at most every REPORT_INTERVAL."""

    def __init__(self, dt: float) -> None:
        self.reason = ''
        self._dt = dt
        self._reported = ('', False)
        self._ticks_to_report = 0

    def report(self, obstacle: str, part: float) -> None:
        """The obstacle of this tick, and the part of the request that is driven."""
        self._ticks_to_report -= 1
        news = obstacle, part == 0.0
        if news != self._reported and self._ticks_to_report <= 0:
            self._reported = news
            self._ticks_to_report = round(REPORT_INTERVAL / self._dt)
            self.reason = f'scaled to {part:.2g}: {obstacle}' if obstacle else ''


class JointJogging:
    """A `Jog` of joint rates."""

    is_of_joints = True

    def __init__(self, machine: Machine, pose: Pose, joints: Array, dt: float) -> None:
        """Begins at rest at `pose`, where the joints are."""
        self.motion = JointMotion.at_rest(pose, joints)
        self._jogger = JointJogger(machine)
        self._report = ObstacleReport(dt)
        self._still = np.zeros(len(joints))
        self._dt = dt

    @property
    def reason(self) -> str:
        """See `Jog`."""
        return self._report.reason

    def takes(self, command: AnyJogCommand) -> bool:
        """See `Jog`."""
        return isinstance(command, JointJogCommand)

    def step(self, request: AnyJogCommand | None, rate: float, measured: Pose | None) -> None:
        """See `Jog`."""
        rates = request.rates if isinstance(request, JointJogCommand) else self._still
        self.motion = self._jogger.step(self.motion, rate * rates, self._dt)
        held_by = PAUSED if rate == 0.0 else self.motion.held_by
        self._report.report(held_by, rate * self.motion.scale)


class Jogging:
    """A `Jog` of twists; poses are T_work_pivot."""

    is_of_joints = False

    def __init__(self, machine: Machine, pose: Pose, joints: Array, dt: float) -> None:
        """Begins at rest at `pose`, where the joints are."""
        self.motion = JogMotion.at_rest(pose, joints)
        self._report = ObstacleReport(dt)
        self._machine = machine
        self._jogger = machine.make_jogger(machine)
        self._dt = dt
        self._mode: JogMode | None = None
        self._held: Held | None = None
        self._command = STILL

    @property
    def reason(self) -> str:
        """See `Jog`."""
        return self._report.reason

    def takes(self, command: AnyJogCommand) -> bool:
        """See `Jog`."""
        return isinstance(command, JogCommand)

    def step(self, request: AnyJogCommand | None, rate: float, measured: Pose | None) -> None:
        """One tick towards the requested twist, at `rate` of its speed; None brakes.

        The mode's loop is closed on the measured pose, or on the commanded one where there is
        none.
        """
        twist, scale, refusal = STILL, 1.0, ''
        request = request if isinstance(request, JogCommand) else None
        try:
            if request is not None or self._command.any():
                twist, scale = self._through_mode(request, measured or self.motion.pose)
        except Refused as error:
            self._held, self._command, refusal = None, STILL, str(error)
        self.motion = self._jogger.step(self.motion, rate * twist, self._dt)
        obstacle = refusal or self._obstacle(scale, rate)
        self._report.report(obstacle, rate * scale * self.motion.scale)

    def _through_mode(self, request: JogCommand | None, pose: Pose) -> tuple[Array, float]:
        """The mode's twist within speed, and the part of the request that it is.

        The request is limited in acceleration before the mode is applied, so that the mode stays
        in effect while the machine speeds up, reverses and brakes.
        """
        motion, target, scale = self._machine.motion, STILL, 1.0
        if request is not None:
            command = in_work_axes(request.twist, request.frame, pose, self._machine.frames)
            target, scale = within_speed(command, motion)
            if self._held is None or self._mode is not request.mode:
                self._held, self._mode = request.mode.latched(pose), request.mode
        self._command = towards(self._command, target, motion, self._dt)
        if self._held is None:
            return STILL, scale
        midway = self.motion.pose.position + 0.5 * self._dt * self.motion.twist[:3]
        twist, self._held = self._held.step(self._command, pose, midway)
        kept, part = within_speed(twist, motion)
        return kept, scale * part

    def _obstacle(self, scale: float, rate: float) -> str:
        if rate == 0.0:
            return PAUSED
        return self.motion.held_by or ('speed limits' if scale < NOTABLE else '')
