"""The bridge between the graph and the board: admits, sends, answers and reports.

No ROS, no thread, no port, no clock: decoded values and times in, values out.
"""

import math
from collections.abc import Sequence
from concurrent.futures import Future
from dataclasses import dataclass, replace
from typing import Protocol

from bridge.calibration import Calibration
from bridge.command_validator import CommandValidator
from bridge.events import (
    Acknowledged,
    CommandFailed,
    Disconnected,
    Event,
    FaultReported,
    Incompatible,
    StateReceived,
)
from bridge.gripper import Gripper
from bridge.link import Link, Ticket
from bridge.link_monitor import JointTable, LinkMonitor, MachineStatus
from bridge.protocol import Arm, Clear, Command, Disarm, Stop
from bridge.servo_config import BoardConfig
from bridge.session import Session
from manipulator.states import MachineState

SERVOS_ON = (MachineState.HOLDING, MachineState.UNCLAIMED, MachineState.PLAYING)
"""Where an ARM moves nothing: the board only takes a new host, or halts its program."""


@dataclass(frozen=True)
class Request:
    """A request to the board, and the answer for success."""

    done: str
    future: 'Future[None]'


@dataclass(frozen=True)
class MachineReport:
    """For `machine_state`; is_followed: the board has accepted a joint command."""

    status: MachineStatus
    is_followed: bool
    is_measured: bool
    board: str
    unknown_joints: tuple[str, ...]


class Listener(Protocol):
    """Publishes the driver's reports, in the driver's thread."""

    def on_joints(self, joints: JointTable) -> None:
        """After each STATE with the position of any joint."""

    def on_machine_state(self, state: MachineReport) -> None:
        """After every event, whether it has changed or not."""

    def on_problem(self, text: str) -> None:
        """Of the board or the line, for people to read."""

    def on_written(self, ticket: Ticket, now: float) -> None:
        """A setpoint was handed to the port; stamped is None where it is by another clock."""


class BoardDriver:
    """One board and its servos.

    It belongs to the thread that has the port, with its link and everything below it.
    `now` is monotonic, in seconds.
    """

    def __init__(
        self,
        config: BoardConfig,
        listener: Listener,
        epoch: float = 0.0,
    ) -> None:
        """`epoch` is the system's clock where `now` is zero, s."""
        self.calibration = Calibration.from_config(config.servos)
        self._deadline = 1e-3 * config.link.setpoint_deadline_ms
        self.validator = CommandValidator(self.calibration, self._deadline)
        self._gripper = Gripper(config.servos, self.calibration, self._deadline)
        self.session = Session(len(self.calibration.names))
        self.monitor = LinkMonitor(self.session, self.calibration)
        rate = config.link.baud / 5  # twice what the line carries
        self.link = Link(self.session, self._note, self._note_written, rate)
        self._listener, self._epoch = listener, epoch
        self._is_followed = False
        self._must_restart = False

    # From the graph

    def command(
        self, names: Sequence[str], positions: Sequence[float], stamp: float | None, now: float
    ) -> None:
        """Sends a joint command (rad or m) to the board, or raises why not.

        stamp: by the sender's clock, s; None means "now". A gripper that it does not name goes on
        as it was requested.
        """
        self._refuse_unless_enabled(now)
        present = self.monitor.positions(now, within=self._deadline)
        names, positions = self._gripper.joined((names, positions), now, present)
        holding_since = self.monitor.holding_since + self._epoch
        setpoint = self.validator.admit(
            names, positions, stamp, now + self._epoch, present, holding_since
        )
        self._gripper.note_admitted()
        self.link.put_setpoint(Ticket(setpoint, now, stamp))

    def aim_gripper(self, opening: float) -> None:
        """From 0 (closed) to 1 (open), with the joint commands that follow; or an error."""
        self._refuse_unless_enabled()
        self._gripper.aim(opening)

    def enable(self, is_on: bool) -> Request:
        """Servos on, one by one, at park; or off."""
        if not is_on:
            return self._request(Disarm(), 'disarmed: no more pulses')
        if self.monitor.status.state is MachineState.ENABLED:
            # An ARM would hold up the setpoints of a machine that is moving.
            return _answered('enabled already')
        park = self.calibration.counts(self.calibration.park)
        done = 'arming: the servos go to park one by one'
        if self.monitor.status.state in SERVOS_ON:
            done = 'enabled: the servos are on already, nothing moves'
        return self._request(Arm(park), done)

    def clear_fault(self) -> Request:
        """Ends a stop or a fault."""
        if self.monitor.is_clear:
            # A CLEAR would hold up the setpoints of a machine that is moving.
            return _answered(f'nothing to clear: the machine is {self.monitor.status.state}')
        return self._request(Clear(), 'cleared: nothing moves until a new command')

    def stop(self) -> Request:
        """Now, or as soon as there is a board."""
        return self._request(Stop(), 'stopped: ~/clear_fault ends it')

    def answer(self, request: Request) -> tuple[bool, str]:
        """Whether the board obeyed, and the answer in words, once the future is done.

        It is done only when machine_state shows the effect.
        """
        error = request.future.exception()
        if error is None:
            return True, request.done
        problem = self.monitor.problem
        return False, f'{error}{f": {problem}" if problem else ""}'

    def _request(self, command: Command, done: str) -> Request:
        return Request(done, self.link.request(command))

    def _refuse_unless_enabled(self, now: float = math.inf) -> None:
        """What comes after a refusal, or after an answer, must start where the joints are.

        now: of a joint command, which may be Overtaken.
        """
        is_enabled = self.monitor.is_enabled_here and self.session.accepts_setpoints
        if self._must_restart or not is_enabled:
            self._must_restart = False
            self.validator.restart()
            self._gripper.restart()
        if not is_enabled:
            raise self.validator.refusal(self._why_not_enabled(), now + self._epoch)

    def _why_not_enabled(self) -> str:
        current = self.monitor.status
        if current.state is MachineState.ENABLED:
            is_stopping = self.session.is_stop_requested
            return 'a STOP is in progress' if is_stopping else 'the board accepts no setpoints now'
        reason = f' ({current.reason})' if current.reason else ''
        return f'{current.state}{reason}'

    # From the board

    def _note(self, event: Event, now: float) -> None:
        self.monitor.note(event, now)
        match event:
            case StateReceived():
                joints = self.monitor.joints
                if joints is not None and any(joints.is_known):
                    self._listener.on_joints(joints)
            case Acknowledged(Arm() | Disarm() | Clear()):
                self._must_restart = True
            case FaultReported():
                self._listener.on_problem(self.monitor.last_refusal)
            case CommandFailed(command, reason):
                self._listener.on_problem(f'{type(command).__name__.upper()}: {reason}')
            case Disconnected(reason) | Incompatible(reason):
                self._listener.on_problem(reason)
        self._listener.on_machine_state(self._state())

    def _state(self) -> MachineReport:
        monitor, status = self.monitor, self.monitor.status
        self._is_followed = self._is_followed and status.state is MachineState.ENABLED
        return MachineReport(
            status, self._is_followed, monitor.is_measured, monitor.board, monitor.unknown_joints
        )

    def _note_written(self, ticket: Ticket, now: float) -> None:
        self._is_followed = True
        stamped = None if self.validator.has_notable_offset else ticket.stamped
        self._listener.on_written(replace(ticket, stamped=stamped), now)


def _answered(done: str) -> Request:
    future: Future[None] = Future()
    future.set_result(None)
    return Request(done, future)
