"""What one inverse kinematics and one arm step cost on the chip, beside the papers' figures."""

import json
import sys
from dataclasses import dataclass

import numpy as np

from firmware.simulator.chip import CLOCK_HZ, Chip
from hexarm.board import build as firmware_build
from hexarm.board.header import header_of

MARKS, DONE = 255, 255
NOTHING, INVERSE, ARM_STEP, SINE, ALGEBRAIC, GEOMETRIC, KERNEL_STEP = 1, 2, 3, 4, 5, 6, 7
TIMES = {
    'inverse_time': INVERSE,
    'step_time': ARM_STEP,
    'sine_time': SINE,
    'algebraic_time': ALGEBRAIC,
    'geometric_time': GEOMETRIC,
}
LONGEST_RUN = 5 * CLOCK_HZ
ANY_BAUD = 250_000


@dataclass(frozen=True)
class Cost:
    """Clock cycles of one call, over the calls of bench.c."""

    mean: float
    longest: int

    @property
    def milliseconds(self) -> float:
        """The longest call at 16 MHz."""
        return 1e3 * self.longest / CLOCK_HZ


def costs(machine: str = 'robocake') -> dict[int, Cost]:
    """By mark, less what the marking itself takes."""
    program = firmware_build.bench(header_of(machine))
    chip = Chip(firmware_build.simulator() / 'chip.so', program, ANY_BAUD)
    chip.run(LONGEST_RUN)
    marks = chip.edges()
    marks = marks[marks['channel'] == MARKS]
    assert marks['level'][-1] == DONE, 'the bench did not come to its end'
    found = {}
    idle = 0.0
    for mark in (NOTHING, INVERSE, ARM_STEP, SINE, ALGEBRAIC, GEOMETRIC, KERNEL_STEP):
        cycles = marks['cycle'][marks['level'] == mark].astype(np.int64)
        spent = cycles[1::2] - cycles[::2]
        idle = float(spent.mean()) if mark == NOTHING else idle
        found[mark] = Cost(float(spent.mean()) - idle, int(spent.max() - idle))
    return found


def main() -> None:
    """Prints the table; with --json, milliseconds by name."""
    found = costs()
    if sys.argv[1:] == ['--json']:
        print(json.dumps({name: found[mark].milliseconds for name, mark in TIMES.items()}))
        return
    rows = (
        ('inverse kinematics, six cranks', INVERSE, 'at 50 Hz there are 20 ms'),
        ('resolved-rate step of an arm', ARM_STEP, '< 20 ms on a C167 (Fadeev, Loginov)'),
        ('damped step of any arm (kernel)', KERNEL_STEP, 'the same'),
        ('inverse of that arm, algebraic', ALGEBRAIC, ''),
        ('inverse of that arm, geometric', GEOMETRIC, ''),
        ('one sine', SINE, '2 ms on a C167'),
    )
    print('ATmega2560 at 16 MHz, simulated; single precision')
    for name, mark, paper in rows:
        cost = found[mark]
        print(f'{name:32} {cost.mean:8.0f} cycles, at most {cost.milliseconds:5.2f} ms   {paper}')


if __name__ == '__main__':
    main()
