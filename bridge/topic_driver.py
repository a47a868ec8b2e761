"""The bridge to a driver of other software: joint commands and joint states by topics.

No board, no port: decoded values and times in, values out. Nothing is commanded before it is
enabled here, nor after a stop; the driver keeps the joints where they are when commands cease.
"""

from collections.abc import Sequence

import numpy as np

from bridge.command_validator import JumpValidator
from bridge.link_monitor import ERROR, OK, WARN, MachineStatus
from manipulator.arrays import Array, frozen
from manipulator.deadlines import BOARD_DEADLINE
from manipulator.errors import InvalidInput, Refused
from manipulator.machine import Machine
from manipulator.states import MachineState

COMMAND_DEADLINE = 0.2
"""Seconds from one joint command to the next, after which the machine is *holding*."""
FIRST_COMMAND = 2.0
"""Seconds from enabling, or from the end of a stop, to the first."""
TURN = 2 * np.pi


class TopicDriver:
    """One machine's; joints (n,) in rad or m, times monotonic, in seconds.

    joints: where they are, None while unknown. A simulated driver's are where they are commanded.
    """

    def __init__(self, machine: Machine, is_simulated: bool, source: str, epoch: float) -> None:
        """source: where the driver reports its joints; epoch: the system's clock at time zero."""
        kinematics = machine.kinematics
        self.names = kinematics.joint_names
        self.is_simulated, self._source, self._epoch = is_simulated, source, epoch
        self._low, self._high = machine.joint_ranges
        self.validator = JumpValidator(
            self.names, kinematics.joint_unit, machine.motion.joint.speed, COMMAND_DEADLINE
        )
        self.joints = kinematics.inverse(kinematics.home) if is_simulated else None
        self.is_followed = False
        self.refusals, self.last_refusal = 0, ''
        self._reported_at, self._missing = float('-inf'), ''
        self._is_enabled = self._is_stopped = False
        self._command_due = float('-inf')

    # From the driver

    def note_joints(self, joints: Array, now: float) -> None:
        """What it reports; a joint without end is counted on from the turn that it was in."""
        last = joints if self.joints is None else self.joints
        turns = np.round((last - joints) / TURN)
        self.joints = frozen(np.where(np.isinf(self._high), joints + TURN * turns, joints))
        self._reported_at = now

    def note_others(self, names: Sequence[str]) -> None:
        """Of a message without all of our joints: another device's, or the names differ."""
        missing = [name for name in self.names if name not in names]
        self._missing = f'; a message without {", ".join(missing)} came instead'

    # From the graph

    def command(
        self, names: Sequence[str], positions: Sequence[float], stamp: float | None, now: float
    ) -> Array:
        """What the driver is to be sent (n,), in the order of `names`; or an error says why not.

        stamp: by the sender's clock, s; None means "now".
        """
        state = self.status(now).state
        if state not in (MachineState.ENABLED, MachineState.HOLDING):
            raise self.validator.refusal(str(state), now + self._epoch)
        target = self.validator.ordered(names, positions)
        self._check_range(target)
        self.validator.take(target, stamp, now + self._epoch, self.joints)
        self._command_due, self.is_followed = now + COMMAND_DEADLINE, True
        if self.is_simulated:
            self.joints = frozen(target)
        return target

    def refuse(self, reason: str) -> None:
        """Notes a command that was not sent on."""
        self.refusals += 1
        self.last_refusal = reason

    def enable(self, is_on: bool, now: float) -> str:
        """Lets commands through from now on, or no more: the answer in words, or Refused."""
        state = self.status(now).state
        if not is_on:
            self._is_enabled = self.is_followed = False
            return 'disabled: no more joint commands'
        if state in (MachineState.DISCONNECTED, MachineState.STOPPED):
            raise Refused(self._in_words(now))
        if not self._is_enabled:
            self._is_enabled = True
            self._begin(now)
        return 'enabled: the driver is sent joint commands'

    def stop(self) -> None:
        """At once, whatever the state; until `clear_fault`."""
        self._is_stopped, self.is_followed = True, False

    def clear_fault(self, now: float) -> str:
        """Ends a stop; nothing moves until a new command."""
        if not self._is_stopped:
            return f'nothing to clear: the machine is {self.status(now).state}'
        self._is_stopped = False
        self._begin(now)
        return 'cleared: nothing moves until a new command'

    def status(self, now: float) -> MachineStatus:
        """The machine state; a driver that falls silent is not enabled any more."""
        silence = now - self._reported_at
        if not self.is_simulated and silence > BOARD_DEADLINE:
            self._is_enabled = self.is_followed = False
            since = 'yet' if np.isinf(silence) else f'for {BOARD_DEADLINE:g} s'
            reason = f'no joint states of its driver on {self._source} {since}{self._missing}'
            return MachineStatus(ERROR, MachineState.DISCONNECTED, reason)
        if self._is_stopped:
            return MachineStatus(WARN, MachineState.STOPPED, 'until ~/clear_fault is called')
        if not self._is_enabled:
            return MachineStatus(OK, MachineState.DISARMED)
        if now > self._command_due:
            self.is_followed = False
            reason = 'no joint command within the deadline'
            return MachineStatus(WARN, MachineState.HOLDING, reason)
        return MachineStatus(OK, MachineState.ENABLED)

    def _begin(self, now: float) -> None:
        """What comes next must start where the joints are."""
        self.validator.restart()
        self.is_followed, self._command_due = False, now + FIRST_COMMAND

    def _in_words(self, now: float) -> str:
        status = self.status(now)
        return f'{status.state}: {status.reason}'

    def _check_range(self, target: Array) -> None:
        outside = np.flatnonzero(~((target >= self._low) & (target <= self._high)))
        if outside.size:
            i = int(outside[0])
            span = f'[{self._low[i]:.4g}, {self._high[i]:.4g}]'
            raise InvalidInput(f'{self.names[i]}: {target[i]:.4g} outside {span}')
