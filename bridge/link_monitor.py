"""What the bridge knows of its board, from the events of the link."""

from dataclasses import dataclass, field

import numpy as np

from bridge.calibration import Calibration
from bridge.events import (
    Acknowledged,
    Connected,
    Disconnected,
    Event,
    FaultReported,
    Incompatible,
    Opened,
    StateReceived,
)
from bridge.latencies import percentiles_ms
from bridge.machine_status import MachineStatus, machine_status
from bridge.messages import NO_JOINT, Arm, Fault, Known, Mode, State
from bridge.session import Session
from manipulator.arrays import Array
from manipulator.words import counted

STATE_PERIOD = 0.02


@dataclass(frozen=True)
class JointTable:
    """Where the joints are: rad (or m) and rad/s (or m/s), NaN where unknown."""

    positions: Array
    velocities: Array

    @property
    def is_known(self) -> tuple[bool, ...]:
        """By joint, in the calibration's order."""
        return tuple(np.isfinite(self.positions).tolist())


@dataclass
class LinkMonitor:
    """Fed with every event; read by the node."""

    session: Session
    calibration: Calibration
    joints: JointTable | None = None
    refusals: int = 0
    last_refusal: str = ''
    trouble: str = ''
    is_enabled_here: bool = False
    is_measured: bool = False
    _seen_at: float = field(default=0.0)

    @property
    def status(self) -> MachineStatus:
        """The state of the machine in one word."""
        return machine_status(self.session, self.is_enabled_here, self.trouble)

    @property
    def is_clear(self) -> bool:
        """There is a board, and no stop or fault to end, nor one that is still to be said."""
        latched_or_unknown = ('disconnected', 'booting', 'stopped', 'fault')
        return not self.session.is_stop_wanted and self.status.word not in latched_or_unknown

    @property
    def board(self) -> str:
        """What the board said of itself."""
        hello = self.session.hello
        if hello is None:
            return 'none'
        cause = hello.reset_cause.name or int(hello.reset_cause)
        return (
            f'protocol {hello.version}, {counted(hello.joint_count, "joint")}, last reset: {cause}'
        )

    @property
    def unknown_joints(self) -> tuple[str, ...]:
        """Joints whose position nobody knows."""
        names = self.calibration.names
        if self.joints is None:
            return names
        pairs = zip(names, self.joints.is_known, strict=True)
        return tuple(name for name, is_known in pairs if not is_known)

    def note(self, event: Event, now: float) -> None:
        """`now` is monotonic, in seconds."""
        match event:
            case Opened():
                self.trouble = ''
            case Connected():
                self.trouble = ''
                self.is_enabled_here = False
            case Disconnected(reason) | Incompatible(reason):
                self.trouble = reason
                self.joints = None
            case Acknowledged(Arm()):
                self.is_enabled_here = True
            case FaultReported(fault):
                self.refuse(f'the board: {self._text(fault)}')
            case StateReceived(state):
                self._note_state(state, now)

    def refuse(self, reason: str) -> None:
        """A command that was not followed."""
        self.refusals += 1
        self.last_refusal = reason

    def report(self) -> dict[str, object]:
        """What /diagnostics tells of the link and the board."""
        session, state = self.session, self.session.state
        values: dict[str, object] = {
            'link': session.phase.value,
            **percentiles_ms('round_trip', session.round_trips.seconds),
            'frames_sent': session.setpoints_sent,
            'refusals': self.refusals,
            'last_refusal': self.last_refusal,
            'bad_frames_received': session.reader.bad_frames + session.reader.overruns,
        }
        if state is not None:
            values |= {
                'battery_v': 1e-3 * state.battery_mv,
                'board_bad_frames': state.bad_frames,
                'board_overruns': state.overruns,
                'board_refusals': state.refused,
            }
        return values

    def _note_state(self, state: State, now: float) -> None:
        if state.mode is Mode.DISARMED:
            self.is_enabled_here = False
        self.is_measured = all(joint.known is Known.MEASURED for joint in state.joints)
        counts = [j.count if j.known is not Known.UNKNOWN else np.nan for j in state.joints]
        positions = self.calibration.positions(counts)
        velocities = np.zeros_like(positions)
        if self.joints is not None:
            periods = max(round((now - self._seen_at) / STATE_PERIOD), 1)
            velocities = (positions - self.joints.positions) / (periods * STATE_PERIOD)
        self.joints = JointTable(positions, np.nan_to_num(velocities))
        self._seen_at = now

    def _text(self, fault: Fault) -> str:
        reason = fault.code.name.lower().replace('_', ' ')
        if fault.joint == NO_JOINT:
            return f'{reason} ({fault.value})'
        if fault.joint not in self.calibration.channels:
            return f'{reason}: channel {fault.joint}, count {fault.value}'
        i = self.calibration.channels.index(fault.joint)
        low, high = self.calibration.lowest[i], self.calibration.highest[i]
        name = self.calibration.names[i]
        return f'{name}: {reason}, count {fault.value} outside [{low}, {high}]'
