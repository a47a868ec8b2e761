"""One servo calibration session: keys in, setpoints out, and the display, until it is over."""

import re
import time
from collections.abc import Callable
from dataclasses import dataclass, replace

from bridge.protocol import Mode
from bridge.servo_config import ServoConfig
from bridge.servo_wizard import ServoWizard, Stage
from hexarm.calibration.servo_line import ServoLine
from manipulator.errors import LinkError, ManipulatorError, Refused
from manipulator.nodes.devices.terminal import Terminal

ARROWS = {'A': 'up', 'B': 'down', 'C': 'right', 'D': 'left'}
CONTROLS = {'\r': 'enter', '\n': 'enter', '\x7f': 'backspace', '\x08': 'backspace'}
UNKNOWN = '?'
MOST_AT_ONCE = 12
"""Keys in one reading; more are a paste or a cat, not a hand."""

_KEY = re.compile('\x1b[\\[O](?P<arrow>[A-D])|\x1b(\\[[0-?]*[ -/]*[@-~]|O.)|.', re.DOTALL)


def key_names(characters: bytes) -> tuple[str, ...]:
    """The keys that were pressed, in order; none for a paste, unless a space is in it.

    Letters and signs are named by themselves, a space is 'space'. It is the key that stops, so
    it is never lost: a paste with one in it is one 'space'.
    """
    names = tuple(map(_name, _KEY.finditer(characters.decode(errors='replace'))))
    if len(names) > MOST_AT_ONCE:
        return ('space',) if 'space' in names else ()
    return names


def _name(found: 're.Match[str]') -> str:
    text = found[0]
    if found['arrow']:
        return ARROWS[found['arrow']]
    if text[0] == '\x1b':
        return 'escape' if len(text) == 1 else UNKNOWN
    return 'space' if text == ' ' else CONTROLS.get(text, text)


HELP = """\
 →/← or d/a  longer, shorter pulse     +/-  step    s  skip    b  this servo again
 SPACE       STOP (c clears it)        q    to the end         Ctrl-C  servos off, nothing kept

"""
CONSENT = """\
Take rods or load off the servos, or keep a hand at the plug: the first pulse moves each servo to
its centre at full speed, one after the other. The graph (hexarm up) must not run meanwhile.
{found}ENTER energises {count} servos, q leaves. """
FOUND = {
    Mode.STOPPED: 'The board is stopped; energising clears that.\n',
    Mode.FAULT: 'The board has a fault; energising clears that.\n',
    Mode.ARMED: 'The servos have power already and stay where they are.\n',
    Mode.HOLDING: 'The servos have power already and stay where they are.\n',
}
"""Printed before anything is energised, by the board's mode."""

LOST = """\
\r\x1b[K{problem}{advice}
w: write what was found so far, q: leave
"""

POSITIVE = {
    'rotary_hexapod': ' (the crank turns from its tangent upwards)',
    'linear_hexapod': ' (the leg grows longer)',
    'rail_hexapod': ' (the carriage moves in the direction of its rail)',
    'serial_arm': ' (a right-hand turn about the axis)',
}
"""The positive direction, by the kind of machine."""


def question(wizard: ServoWizard, positive: str) -> str:
    """The question of the present stage."""
    servo, unit = wizard.servo, 'mm' if wizard.servo.is_linear else '°'
    low, high = servo.pulse_range_us
    question_text = {
        Stage.DIRECTION: f'jog it. Does a longer pulse (→) move it towards positive{positive}? '
        'y or n',
        Stage.CENTRE: f'bring it to {servo.centre:g} {unit} and press ENTER; '
        'or bring it anywhere and type =ANGLE ENTER',
        Stage.SCALE: 'bring it to a second angle that you can read and type =ANGLE ENTER; '
        's keeps the scale',
        Stage.RANGE: f'pulses {low:g} to {high:g} µs: where it must not go so far, jog to the '
        'end and press [ or ]; ENTER goes on',
        Stage.RETURN: 'goes back to its centre',
        Stage.REVIEW: 'w: servos off and write, q: servos off and leave',
    }.get(wizard.stage, '')
    name = 'end' if wizard.stage is Stage.REVIEW else f'{servo.name}, {wizard.stage.value}'
    return f'{name}: {question_text}\n'


def status(wizard: ServoWizard, stopped: bool, seen: str) -> str:
    """The line that is rewritten all the time."""
    typed = '' if wizard.typed is None else f'  ={wizard.typed}_'
    notice = 'STOPPED, c clears it' if stopped else wizard.notice
    notice = f'  {notice}' if notice else ''
    return (
        f' {wizard.servo.name}  {wizard.pulse:7.1f} µs  step {wizard.step:g}{seen}{typed}{notice}'
    )


TICK, LONGEST_TICK = 0.02, 0.1
LATCHED = (Mode.STOPPED, Mode.FAULT)


class TerminalGone(ManipulatorError):
    """The terminal has closed: the machine is not watched any more."""


@dataclass(frozen=True)
class CalibrationSession:
    """Terminal and board of one machine; `display` returns the position of a fake servo."""

    terminal: Terminal
    line: ServoLine
    servos: tuple[ServoConfig, ...]
    chosen: tuple[int, ...]
    positive: str
    display: Callable[[int], str]

    def run(self) -> ServoWizard | None:
        """The wizard at its end, None where the user did not begin.

        TerminalGone: it cannot go on; LinkError: nor can it, and nothing was found so far;
        Refused: the board does not energise.
        """
        if not self._has_consent():
            return None
        centres = tuple(servo.centre_us for servo in self.servos)
        if self.line.mode in LATCHED:
            self.line.clear()
        self.line.energise(ServoWizard.begin(self.servos, centres, self.chosen).counts)
        wizard = ServoWizard.begin(self.servos, self._pulses(), self.chosen)
        self.terminal.show(f'\n{HELP}{question(wizard, self.positive)}')
        last = time.monotonic()
        while not wizard.is_over:
            time.sleep(TICK)
            now = time.monotonic()
            try:
                before, wizard = wizard, self._turn(wizard, min(now - last, LONGEST_TICK))
            except LinkError as error:
                if wizard.servos == self.servos:
                    raise
                return self._review(wizard, str(error))
            last = now
            self._show(before, wizard)
        return wizard

    def _review(self, wizard: ServoWizard, problem: str) -> ServoWizard:
        """Servos off, for the board is lost; what was found is not, where the user wants it."""
        self.line.switch_off()
        advice = '' if self.line.is_off else ': pull the plug of the servos'
        self.terminal.show(LOST.format(problem=problem, advice=advice))
        wizard = replace(wizard, stage=Stage.REVIEW, typed=None)
        while not wizard.is_over:
            time.sleep(TICK)
            for key in key_names(self._characters()):
                wizard = wizard.press(key)
        return wizard

    def _has_consent(self) -> bool:
        found = '' if self.line.mode is None else FOUND.get(self.line.mode, '')
        self.terminal.show(CONSENT.format(found=found, count=len(self.servos)))
        while True:
            time.sleep(TICK)
            keys = self._keys()
            if 'enter' in keys or 'q' in keys:
                return 'q' not in keys

    def _turn(self, wizard: ServoWizard, dt: float) -> ServoWizard:
        keys = self._keys()
        if 'space' in keys:
            self.line.stop()
            return wizard
        if self.line.mode is Mode.STOPPED:
            if 'c' in keys:
                self._clear()
            return wizard.stopped_at(self._pulses())
        for key in keys:
            wizard = wizard.press(key)
        wizard = wizard.advance(dt)
        self.line.move(wizard.counts)
        return wizard

    def _clear(self) -> None:
        try:
            self.line.clear()
        except Refused as error:  # the stop button is pressed, or the battery low
            self.terminal.show(f'\r\x1b[Knot cleared: {error}\n')

    def _keys(self) -> tuple[str, ...]:
        """The keys since the last call; raises where terminal or board have gone."""
        characters = self._characters()
        if self.line.problem:
            raise LinkError(self.line.problem)
        if self.line.has_released:
            raise LinkError('the board has taken the power from the servos')
        return key_names(characters)

    def _characters(self) -> bytes:
        characters = self.terminal.read()
        if characters is None:
            raise TerminalGone('the terminal was closed')
        return characters

    def _pulses(self) -> tuple[float, ...]:
        by_channel = self.line.pulses
        return tuple(by_channel[servo.channel] for servo in self.servos)

    def _show(self, before: ServoWizard, wizard: ServoWizard) -> None:
        """The question where there is a new one, and the status line."""
        if (before.stage, before.at) != (wizard.stage, wizard.at) and not wizard.is_over:
            self.terminal.show(f'\r\x1b[K{question(wizard, self.positive)}')
        is_stopped = self.line.mode is Mode.STOPPED
        seen = '' if wizard.stage is Stage.REVIEW else self.display(wizard.index)
        self.terminal.show(f'\r\x1b[K{status(wizard, is_stopped, seen)}')
