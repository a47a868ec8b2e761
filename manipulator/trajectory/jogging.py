"""An active jog: one source's twists through a jog mode, within speed and machine limits."""

from dataclasses import dataclass

import numpy as np

from manipulator.arrays import Array
from manipulator.errors import Refused
from manipulator.machine import Machine
from manipulator.pose import Pose
from manipulator.teleop.jog_modes import Held, JogMode
from manipulator.teleop.jogger import JogMotion, in_work_axes, towards, within_speed

REPORT_INTERVAL = 0.5
"""Seconds between two changes of the reported obstacle."""
NOTABLE = 0.995
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


class Jogging:
    """From rest, through twists, to rest again; poses are T_work_pivot."""

    def __init__(self, machine: Machine, pose: Pose, joints: Array, dt: float) -> None:
        """Begins at rest at `pose`, where the joints are."""
        self.motion = JogMotion.at_rest(pose, joints)
        self.reason = ''
        self._machine = machine
        self._jogger = machine.make_jogger(machine)
        self._dt = dt
        self._mode: JogMode | None = None
        self._held: Held | None = None
        self._command = STILL
        self._reported = ('', False)
        self._ticks_to_report = 0

    def step(self, request: JogCommand | None, rate: float, measured: Pose | None) -> None:
        """One tick towards the requested twist, at `rate` of its speed; None brakes.

        The mode's loop is closed on the measured pose, or on the commanded one where there is
        none.
        """
        twist, scale, refusal = STILL, 1.0, ''
        try:
            if request is not None or self._command.any():
                twist, scale = self._through_mode(request, measured or self.motion.pose)
        except Refused as error:
            self._held, self._command, refusal = None, STILL, str(error)
        self.motion = self._jogger.step(self.motion, rate * twist, self._dt)
        self._report(refusal or self._obstacle(scale, rate), rate * scale * self.motion.scale)

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
            return 'paused, or speed override 0'
        return self.motion.held_by or ('speed limits' if scale < NOTABLE else '')

    def _report(self, obstacle: str, part: float) -> None:
        """Updates the reported obstacle when it changes, at most every REPORT_INTERVAL."""
        self._ticks_to_report -= 1
        news = obstacle, part == 0.0
        if news != self._reported and self._ticks_to_report <= 0:
            self._reported = news
            self._ticks_to_report = round(REPORT_INTERVAL / self._dt)
            self.reason = f'scaled to {part:.2g}: {obstacle}' if obstacle else ''
