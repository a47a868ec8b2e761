"""From the sources of twists to the executor: the owner, its jog mode and its jog commands."""

from collections.abc import Mapping
from typing import NoReturn

import numpy as np

from manipulator.arrays import Array, frozen
from manipulator.errors import InvalidInput, Refused
from manipulator.frames import Frames
from manipulator.planning.joint_move import refuse_rule
from manipulator.planning.joint_points import check_names
from manipulator.teleop.arbiter import Arbiter
from manipulator.teleop.jog_modes import Feedback, JogMode
from manipulator.teleop.jogger import check_axes
from manipulator.teleop.modes import check_name, jog_mode
from manipulator.trajectory.jogging import JogCommand, JointJogCommand
from manipulator.trajectory.supervisor import MotionSupervisor

PLAIN = 'free'


class Teleop:
    """Receives twists and jog modes; `drive` passes the jog command to the executor, once a tick.

    Times are monotonic, in seconds.
    """

    def __init__(self, supervisor: MotionSupervisor, delay: float) -> None:
        """delay: how old a measured pose is by the time that its correction moves the joints."""
        self._supervisor = supervisor
        self._delay = delay
        self._arbiter = Arbiter()
        self._requested: tuple[Array, str] | Array = (np.zeros(6), '')
        self._name = PLAIN
        self._point: Array | None = None
        self._is_measured = supervisor.is_measured
        self._made_name, self._mode = PLAIN, self._made(PLAIN)

    @property
    def mode(self) -> str:
        """The name of the jog mode that was requested last."""
        return self._name

    def owner(self, now: float) -> str:
        """The source that controls the machine, '' where none does."""
        return self._arbiter.owner(now)

    def receive(self, source: str, twist: Array, frame: str, now: float) -> None:
        """A twist (6,) of the pivot in the axes of `frame`; Refused with the reason."""
        check_axes(frame)
        self._accept(source, now)
        self._requested = frozen(twist), frame

    def receive_joints(self, source: str, named: Mapping[str, float], now: float) -> None:
        """Rates of some joints by name (rad/s or m/s); Refused or InvalidInput with the reason."""
        names = self._supervisor.machine.kinematics.joint_names
        refuse_rule(len(names))
        check_names(tuple(named), names)
        rates = np.array([named.get(name, 0.0) for name in names])
        if not np.isfinite(rates).all():
            name = names[int(np.argmin(np.isfinite(rates)))]
            raise InvalidInput(f'rate of {name} is {named[name]}, needs a finite number')
        self._accept(source, now)
        self._requested = frozen(rates)

    def reject(self, source: str, now: float, reason: str) -> NoReturn:
        """Raises Refused with the reason; the source must release before it is accepted again."""
        self._arbiter.reject(source, now, reason)

    def set_mode(self, name: str) -> None:
        """Another jog mode; Refused for unknown names, the last one stays.

        look_at waits for its point: until there is one, the last mode stays as well.
        """
        check_name(name)
        self._name = name
        self._take(name)

    def look_at(self, point: Array, is_in_work: bool = False) -> None:
        """The point (3,) of the mode look_at, in the base frame or the work frame."""
        to_work = self._supervisor.machine.frames.T_base_work.inverse()
        self._point = frozen(point if is_in_work else to_work.transform(point[None])[0])
        self._take(self._name)

    def point_in(self, frames: Frames, is_in_work: bool) -> Array | None:
        """The point (3,) of look_at, in the work frame or the base frame; None until it is set."""
        if self._point is None or is_in_work:
            return self._point
        point: Array = frames.T_base_work.transform(self._point[None])[0]
        return point

    def stop(self) -> None:
        """The owning source is rejected until it releases."""
        self._arbiter.stop()

    def drive(self, now: float) -> None:
        """Passes on the jog command of the owning source."""
        try:
            executor = self._supervisor.executor
        except Refused:
            self._arbiter.stop()
            return
        source = self._arbiter.owner(now)
        if not source:
            executor.jog(None)
            return
        if self._supervisor.is_measured != self._is_measured:
            self._is_measured = self._supervisor.is_measured
            self._take(self._made_name)
        if isinstance(self._requested, tuple):
            executor.jog(JogCommand(source, *self._requested, self._mode))
        else:
            executor.jog(JointJogCommand(source, self._requested))

    def _accept(self, source: str, now: float) -> None:
        """Refused with the reason unless the source's messages count."""
        try:
            is_busy = self._supervisor.executor.is_busy
        except Refused as refusal:
            self._arbiter.reject(source, now, str(refusal))
        self._arbiter.receive(source, now, is_busy)

    def _take(self, name: str) -> None:
        self._mode = self._made(name)
        self._made_name = name

    def _made(self, name: str) -> JogMode:
        feedback = Feedback.for_delay(self._delay if self._is_measured else 0.0)
        return jog_mode(name, feedback, self._point)
