"""A fake board in this process, with servos that are mounted otherwise than the file says.

So that a calibration can be tried without a board: what the eye would see on a machine stands on
the screen instead.
"""

import random
import tempfile
from dataclasses import replace
from pathlib import Path

from bridge.fake.board_thread import BoardThread, FakeMachine
from bridge.fake.fake_line import FakeLine
from bridge.servo_config import BoardConfig, ServoConfig
from manipulator.arrays import Array

MOST_OFF_US = 60.0
BOOT_S = 0.3


def mounted_wrongly(config: BoardConfig, seed: int) -> BoardConfig:
    """The same board with some servos the other way round, and all centres off by up to 60 µs."""
    luck = random.Random(seed)

    def wrong(servo: ServoConfig) -> ServoConfig:
        low, high = servo.pulse_range_us
        centre = servo.centre_us + round(luck.uniform(-MOST_OFF_US, MOST_OFF_US))
        centre = min(max(centre, low), high)
        return replace(servo, sign=luck.choice((-1, 1)), centre_us=centre)

    # Nothing is asked of the true park position: the board only ever gets pulses.
    joints = tuple(map(wrong, config.servos.joints))
    centres = tuple(joint.centre_mm or joint.centre_deg or 0.0 for joint in joints)
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
        self._board = BoardThread(machine, FakeLine(Path(self.port)), self._look)

    def __enter__(self) -> 'FakeServos':
        """Powers the board."""
        self._board.start()
        return self

    def __exit__(self, *exception: object) -> None:
        """Ends the board's thread and removes its port."""
        self._board.close()
        self._folder.cleanup()

    def _look(self, positions: Array) -> None:
        self.positions = positions
