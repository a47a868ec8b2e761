"""One sitting at the machine: keys in, setpoints out, until the walk is over."""

import time
from collections.abc import Callable
from dataclasses import dataclass

from bridge.protocol import Mode
from bridge.servo_config import ServoConfig
from bridge.servo_walk import ServoWalk, Stage
from hexarm.calibration.servo_line import ServoLine
from hexarm.calibration.servo_screen import CONSENT, FOUND, HELP, question, status
from manipulator.errors import LinkError, ManipulatorError, Refused
from manipulator.nodes.terminal import Terminal
from manipulator.teleop.key_names import key_names

TICK, LONGEST_TICK = 0.02, 0.1
LATCHED = (Mode.STOPPED, Mode.FAULT)


class TerminalGone(ManipulatorError):
    """Nobody is there any more to watch the machine."""


@dataclass(frozen=True)
class Sitting:
    """Terminal and board of one machine; `look` tells where a fake servo stands."""

    terminal: Terminal
    line: ServoLine
    servos: tuple[ServoConfig, ...]
    chosen: tuple[int, ...]
    positive: str
    look: Callable[[int], str]

    def run(self) -> ServoWalk | None:
        """The walk at its end, None where the person did not want to begin.

        TerminalGone, LinkError: it cannot go on; Refused: the board does not energise.
        """
        if not self._has_consent():
            return None
        centres = tuple(servo.centre_us for servo in self.servos)
        if self.line.mode in LATCHED:
            self.line.clear()
        self.line.energise(ServoWalk.begin(self.servos, centres, self.chosen).counts)
        walk = ServoWalk.begin(self.servos, self._pulses(), self.chosen)
        self.terminal.show(f'\n{HELP}{question(walk, self.positive)}')
        last = time.monotonic()
        while not walk.is_over:
            time.sleep(TICK)
            now = time.monotonic()
            before, walk = walk, self._turn(walk, min(now - last, LONGEST_TICK))
            last = now
            self._show(before, walk)
        return walk

    def _has_consent(self) -> bool:
        found = '' if self.line.mode is None else FOUND.get(self.line.mode, '')
        self.terminal.show(CONSENT.format(found=found, count=len(self.servos)))
        while True:
            time.sleep(TICK)
            keys = self._keys()
            if 'enter' in keys or 'q' in keys:
                return 'q' not in keys

    def _turn(self, walk: ServoWalk, dt: float) -> ServoWalk:
        keys = self._keys()
        if 'space' in keys:
            self.line.stop()
            return walk
        if self.line.mode is Mode.STOPPED:
            if 'c' in keys:
                self._clear()
            return walk.stood(self._pulses())
        for key in keys:
            walk = walk.press(key)
        walk = walk.advance(dt)
        self.line.move(walk.counts)
        return walk

    def _clear(self) -> None:
        try:
            self.line.clear()
        except Refused as error:  # the stop button is pressed, or the battery low
            self.terminal.show(f'\r\x1b[Knot cleared: {error}\n')

    def _keys(self) -> tuple[str, ...]:
        """What was pressed since the last call, as long as there is a person and a board."""
        characters = self.terminal.read()
        if characters is None:
            raise TerminalGone('the terminal has gone')
        if self.line.trouble:
            raise LinkError(self.line.trouble)
        if self.line.has_let_go:
            raise LinkError('the board has taken the power from the servos')
        return key_names(characters)

    def _pulses(self) -> tuple[float, ...]:
        by_channel = self.line.pulses
        return tuple(by_channel[servo.channel] for servo in self.servos)

    def _show(self, before: ServoWalk, walk: ServoWalk) -> None:
        """The question where there is a new one, and the line that is always new."""
        if (before.stage, before.at) != (walk.stage, walk.at) and not walk.is_over:
            self.terminal.show(f'\r\x1b[K{question(walk, self.positive)}')
        is_stopped = self.line.mode is Mode.STOPPED
        seen = '' if walk.stage is Stage.REVIEW else self.look(walk.index)
        self.terminal.show(f'\r\x1b[K{status(walk, is_stopped, seen)}')
