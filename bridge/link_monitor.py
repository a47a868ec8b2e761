"""What the bridge knows of its board, from the events of the link: state, joints, latencies."""

import math
from collections import deque
from collections.abc import Iterable
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
    Phase,
    StateReceived,
)
from bridge.protocol import NO_JOINT, Arm, Fault, FaultCode, Known, Mode, State
from bridge.session import Session
from manipulator.arrays import Array
from manipulator.formatting import counted
from manipulator.states import MachineState


class Latencies:
    """Keeps the newest of them, in seconds."""

    def __init__(self, keep: int = 1000) -> None:
        self._seconds: deque[float] = deque(maxlen=keep)

    def add(self, seconds: float) -> None:
        """One more; negative ones (two clocks) count as zero."""
        self._seconds.append(max(seconds, 0.0))

    def report(self, name: str) -> dict[str, float]:
        """p50 and p99 in milliseconds, by name; empty when there are none."""
        return percentiles_ms(name, tuple(self._seconds))


def percentiles_ms(name: str, seconds: Iterable[float]) -> dict[str, float]:
    """{name}_p50_ms and {name}_p99_ms; empty where there is nothing to sort."""
    ordered = sorted(seconds)
    if not ordered:
        return {}
    p50, p99 = (ordered[min(int(q * len(ordered)), len(ordered) - 1)] for q in (0.5, 0.99))
    return {f'{name}_p50_ms': 1e3 * p50, f'{name}_p99_ms': 1e3 * p99}


OK, WARN, ERROR = 0, 1, 2


@dataclass(frozen=True)
class MachineStatus:
    """level is OK, WARN or ERROR; `reason` is empty where nothing is wrong."""

    level: int
    state: MachineState
    reason: str = ''


_MODES = {
    Mode.DISARMED: MachineStatus(OK, MachineState.DISARMED),
    Mode.ARMING: MachineStatus(OK, MachineState.ARMING),
    Mode.ARMED: MachineStatus(OK, MachineState.ENABLED),
    Mode.HOLDING: MachineStatus(
        WARN, MachineState.HOLDING, 'no joint command within the deadline'
    ),
    Mode.STOPPED: MachineStatus(WARN, MachineState.STOPPED, 'until ~/clear_fault is called'),
    Mode.FAULT: MachineStatus(ERROR, MachineState.FAULT),
    Mode.CHECKING: MachineStatus(OK, MachineState.PLAYING, 'the board checks its program'),
    Mode.PLAYING: MachineStatus(OK, MachineState.PLAYING, 'the board plays its program'),
}
_FAULTS = {FaultCode.UNDERVOLTAGE: 'the battery is too low'}


def machine_status(session: Session, is_enabled_here: bool, problem: str) -> MachineStatus:
    """The state of the machine; `problem` is why there is no board, where there is none."""
    if session.phase is Phase.INCOMPATIBLE:
        return MachineStatus(ERROR, MachineState.FAULT, problem)
    state = session.state
    if session.phase is not Phase.READY or state is None:
        if problem or session.phase is Phase.CLOSED:
            return MachineStatus(ERROR, MachineState.DISCONNECTED, problem)
        return MachineStatus(WARN, MachineState.BOOTING, 'waiting for HELLO from the board')
    if state.mode is Mode.FAULT:
        return MachineStatus(
            ERROR, MachineState.FAULT, _FAULTS.get(state.fault, state.fault.name.lower())
        )
    if state.mode in (Mode.ARMED, Mode.HOLDING) and not is_enabled_here:
        reason = 'the servos are on, but were not enabled by this bridge: call ~/enable'
        return MachineStatus(WARN, MachineState.UNCLAIMED, reason)
    return _MODES[state.mode]


BOARD_STATE_PERIOD = 0.02
"""Seconds between two STATEs of the board."""


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
    problem: str = ''
    is_enabled_here: bool = False
    is_measured: bool = False
    holding_since: float = -math.inf
    """When the board was found to hold, on the clock of `now`; −∞ while it does not."""
    _seen_at: float = field(default=0.0)

    @property
    def status(self) -> MachineStatus:
        """The machine state."""
        return machine_status(self.session, self.is_enabled_here, self.problem)

    @property
    def is_clear(self) -> bool:
        """There is a board, and no stop or fault to clear, nor one that is still to be sent."""
        latched_or_unknown = (
            MachineState.DISCONNECTED,
            MachineState.BOOTING,
            MachineState.STOPPED,
            MachineState.FAULT,
        )
        return not self.session.is_stop_requested and self.status.state not in latched_or_unknown

    def positions(self, now: float, within: float) -> Array | None:
        """Where the joints (n,) were, at most so many seconds ago; None where that is unknown."""
        if self.joints is None or now - self._seen_at > within:
            return None
        return self.joints.positions

    @property
    def board(self) -> str:
        """The board's firmware, from its HELLO."""
        hello = self.session.hello
        if hello is None:
            return 'none'
        cause = hello.reset_cause.name or int(hello.reset_cause)
        return (
            f'protocol {hello.version}, {counted(hello.joint_count, "joint")}, last reset: {cause}'
        )

    @property
    def unknown_joints(self) -> tuple[str, ...]:
        """Joints whose position is unknown."""
        names = self.calibration.names
        if self.joints is None:
            return names
        pairs = zip(names, self.joints.is_known, strict=True)
        return tuple(name for name, is_known in pairs if not is_known)

    def note(self, event: Event, now: float) -> None:
        """`now` is monotonic, in seconds."""
        match event:
            case Opened():
                self.problem = ''
            case Connected():
                self.problem = ''
                self.is_enabled_here = False
            case Disconnected(reason) | Incompatible(reason):
                self.problem = reason
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
        """The values of /diagnostics about the link and the board."""
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
        if state.mode is not Mode.HOLDING:
            self.holding_since = -math.inf
        elif math.isinf(self.holding_since):
            self.holding_since = now
        self.is_measured = all(joint.known is Known.MEASURED for joint in state.joints)
        counts = [j.count if j.known is not Known.UNKNOWN else np.nan for j in state.joints]
        positions = self.calibration.positions(counts)
        velocities = np.zeros_like(positions)
        if self.joints is not None:
            periods = max(round((now - self._seen_at) / BOARD_STATE_PERIOD), 1)
            velocities = (positions - self.joints.positions) / (periods * BOARD_STATE_PERIOD)
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
