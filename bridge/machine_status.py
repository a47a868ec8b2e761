"""One word for the state of the machine, as people and nodes read it on `machine_state`."""

from dataclasses import dataclass

from bridge.events import Phase
from bridge.messages import FaultCode, Mode
from bridge.session import Session

OK, WARN, ERROR = 0, 1, 2


@dataclass(frozen=True)
class MachineStatus:
    """level is OK, WARN or ERROR; `word` one of disconnected, booting, disarmed, arming, enabled,
    holding, unclaimed, playing, stopped, fault; `reason` is empty where all is well.
    """

    level: int
    word: str
    reason: str = ''


_MODES = {
    Mode.DISARMED: MachineStatus(OK, 'disarmed'),
    Mode.ARMING: MachineStatus(OK, 'arming'),
    Mode.ARMED: MachineStatus(OK, 'enabled'),
    Mode.HOLDING: MachineStatus(WARN, 'holding', 'no joint command within the deadline'),
    Mode.STOPPED: MachineStatus(WARN, 'stopped', 'until ~/clear_fault is called'),
    Mode.FAULT: MachineStatus(ERROR, 'fault'),
    Mode.CHECKING: MachineStatus(OK, 'playing', 'the board checks its program'),
    Mode.PLAYING: MachineStatus(OK, 'playing', 'the board plays its program'),
}
_FAULTS = {FaultCode.UNDERVOLTAGE: 'the battery is too low'}


def machine_status(session: Session, is_enabled_here: bool, trouble: str) -> MachineStatus:
    """The state of the machine; `trouble` is why there is no board, where there is none."""
    if session.phase is Phase.INCOMPATIBLE:
        return MachineStatus(ERROR, 'fault', trouble)
    state = session.state
    if session.phase is not Phase.READY or state is None:
        if trouble or session.phase is Phase.CLOSED:
            return MachineStatus(ERROR, 'disconnected', trouble)
        return MachineStatus(WARN, 'booting', 'waiting for the board to say HELLO')
    if state.mode is Mode.FAULT:
        return MachineStatus(ERROR, 'fault', _FAULTS.get(state.fault, state.fault.name.lower()))
    if state.mode in (Mode.ARMED, Mode.HOLDING) and not is_enabled_here:
        reason = 'the servos are on, but this bridge was not asked: call ~/enable'
        return MachineStatus(WARN, 'unclaimed', reason)
    return _MODES[state.mode]
