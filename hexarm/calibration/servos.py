"""`hexarm calibrate servos MACHINE`: signs and centres, one servo at a time, by the keyboard.

Without a board it uses a fake one in this process, whose servos are mounted otherwise than the
file says; what one would see on a machine is shown on the screen.
"""

import argparse
import math
import random
import signal
import tempfile
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import replace
from pathlib import Path

from bridge.fake.board_thread import BoardThread, FakeMachine
from bridge.fake.fake_line import FakeLine
from bridge.servo_config import BoardConfig, ServoConfig
from bridge.servo_wizard import ServoWizard, Stage
from hexarm.calibration.machine_writer import MachineWriter
from hexarm.calibration.servo_line import SIGNALS, ServoLine, changed_values, in_words
from hexarm.calibration.servo_session import POSITIVE, CalibrationSession
from hexarm.cli.statuses import INTERRUPTED
from hexarm.machines import read
from manipulator.arrays import Array
from manipulator.errors import InvalidInput
from manipulator.formatting import counted, did_you_mean, nearest, shown
from manipulator.nodes.devices.terminal import Terminal
from manipulator.yaml_edit import with_values

MOST_OFF_US = 60.0
BOOT_S = 0.3


def mounted_wrongly(config: BoardConfig, seed: int) -> BoardConfig:
    """The same board with some servos reversed, and all centres off by up to 60 µs."""
    luck = random.Random(seed)

    def wrong(servo: ServoConfig) -> ServoConfig:
        low, high = servo.pulse_range_us
        centre = servo.centre_us + round(luck.uniform(-MOST_OFF_US, MOST_OFF_US))
        centre = min(max(centre, low), high)
        return replace(servo, sign=luck.choice((-1, 1)), centre_us=centre)

    # The true park position does not matter: the board only ever gets pulses.
    joints = tuple(map(wrong, config.servos.joints))
    centres = tuple(joint.centre for joint in joints)
    if joints[0].is_linear:
        servos = replace(config.servos, joints=joints, park_mm=centres)
    else:
        servos = replace(config.servos, joints=joints, park_deg=centres)
    return replace(config, servos=servos)


class FakeServos:
    """A context manager: the board runs between enter and exit; `port` is where it is found."""

    def __init__(self, truth: BoardConfig) -> None:
        self._folder = tempfile.TemporaryDirectory(prefix='hexarm-')
        self.port = str(Path(self._folder.name) / 'board')
        machine = FakeMachine.from_config(truth, BOOT_S, truth.hysteresis)
        self.positions = machine.servos.positions
        self._board = BoardThread(machine, FakeLine(Path(self.port)), self._display)

    def __enter__(self) -> 'FakeServos':
        """Powers the board."""
        self._board.start()
        return self

    def __exit__(self, *exception: object) -> None:
        """Ends the board's thread and removes its port."""
        self._board.close()
        self._folder.cleanup()

    def _display(self, positions: Array) -> None:
        self.positions = positions


SEED = 7


def add_parser(parts: 'argparse._SubParsersAction[argparse.ArgumentParser]') -> None:
    """Declares the part."""
    parser = parts.add_parser('servos', help='signs and centres, one servo at a time')
    parser.add_argument('machine', metavar='MACHINE', help='a shipped name or the path of a file')
    parser.add_argument(
        '--port', default='fake', metavar='PATH',
        help="the board's device, or 'fake' (default): servos mounted wrongly, to try it",
    )  # fmt: skip
    parser.add_argument('--only', metavar='NAME', nargs='+', help='these servos, not all')
    parser.add_argument('--output', metavar='FILE', help='write a copy instead of MACHINE')
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    """Walks through the servos and writes what was found; status 0 unless it could not be done."""
    writer = MachineWriter(arguments.machine, arguments.output)
    file = read(arguments.machine)
    config = BoardConfig.from_machine(file, str(writer.source))
    chosen = chosen_servos(config.servos.joints, arguments.only)
    try:
        wizard = _run_session(arguments.port, config, chosen, POSITIVE.get(file.kind, ''))
    except KeyboardInterrupt:
        print('interrupted: nothing was written')
        return INTERRUPTED
    before = config.servos.joints
    if wizard is None or wizard.stage is not Stage.WRITE or wizard.servos == before:
        print('nothing was written')
        return 0
    values = changed_values(before, wizard.servos)
    print('\n'.join(in_words(before, wizard.servos)))
    problems = writer.write(with_values(writer.text, values))
    print(f'{writer.target}: {counted(len(values), "value")} written')
    for problem in problems:
        print(f'  to be looked at: {problem}')
    return 0


def chosen_servos(servos: tuple[ServoConfig, ...], names: list[str] | None) -> tuple[int, ...]:
    """The servos to calibrate; InvalidInput names an unknown one."""
    known = [servo.name for servo in servos]
    for name in names or ():
        if name not in known:
            hint = did_you_mean(nearest(name, known))
            there = ', '.join(known)
            raise InvalidInput(f'no servo is called {shown(name)}{hint} (there are {there})')
    return tuple(known.index(name) for name in names or known)


def _run_session(
    port: str, config: BoardConfig, chosen: tuple[int, ...], positive: str
) -> ServoWizard | None:
    with ExitStack() as stack:
        terminal = stack.enter_context(Terminal())
        stack.enter_context(_signals_interrupt())
        display: Callable[[int], str] = lambda i: ''  # noqa: E731
        if port == 'fake':
            fake = stack.enter_context(FakeServos(mounted_wrongly(config, SEED)))
            port, display = fake.port, _eyes(fake, config)
        line = ServoLine(port, config)
        try:
            with line:
                servos = config.servos.joints
                return CalibrationSession(terminal, line, servos, chosen, positive, display).run()
        finally:
            terminal.show(f'\r\x1b[K{_farewell(line)}\n')


def _eyes(fake: FakeServos, config: BoardConfig) -> Callable[[int], str]:
    """What one would see on a machine, in words."""
    if config.servos.joints[0].is_linear:
        return lambda i: f'  [seen: {1e3 * fake.positions[i]:.1f} mm]'
    return lambda i: f'  [seen: {math.degrees(fake.positions[i]):.1f}°]'


def _farewell(line: ServoLine) -> str:
    if not line.is_in_use:
        return 'the servos were left as they were'
    if line.is_off:
        return 'servos off'
    return 'the board has not confirmed that the servos are off: pull their plug'


@contextmanager
def _signals_interrupt() -> Iterator[None]:
    """What would end the process raises KeyboardInterrupt, so that the servos go off."""
    before = {number: signal.signal(number, signal.default_int_handler) for number in SIGNALS}
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
