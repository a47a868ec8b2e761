"""The board's figures, measured on the simulated chip: `make -C firmware figures`."""

import random

import numpy as np

from bridge.protocol import Mode, ResetCause, Setpoint, Stop
from firmware.simulator.chip import CLOCK_HZ, CYCLES_A_COUNT
from firmware.simulator.host import PARK, PERIOD, Host

FAR = (4800, 1200, 4800, 1200, 4800, 1200)
TICK = 0.0005
PHASES = 40


def armed() -> Host:
    """A board whose servos stand at PARK."""
    host = Host()
    host.arm()
    return host


def jitter_us(seconds: float = 60.0) -> float:
    """The largest error of any pulse's width or period while 100 setpoints a second arrive."""
    host, rng = armed(), random.Random(3)
    worst = 0
    for _ in range(round(seconds)):
        for _ in range(100):
            host.send(Setpoint(200, PARK))
            host.run(rng.uniform(0.005, 0.015))
        rises, widths = host.pulses()
        worst = max(worst, int(np.abs(widths - CYCLES_A_COUNT * np.array(PARK)).max()))
        worst = max(worst, int(np.abs(np.diff(rises, axis=0) - PERIOD).max()))
    return 1e6 * worst / CLOCK_HZ


def stand_still_ms(deadline_ms: int | None) -> list[float]:
    """From the last setpoint (or, without a deadline, from a STOP) to the last pulse that differs
    from the one before by more than a count, at phases all over the period. (The simulated edges
    are exact to 4 cycles, half a count.)
    """
    host, found = armed(), []
    for phase in range(0, 40_000, 40_000 // PHASES):
        host.send(Setpoint(1000, PARK))
        host.run(0.5)
        host.pulses()
        host.run_to_phase(phase)
        host.send(Setpoint(1000 if deadline_ms is None else deadline_ms, FAR))
        if deadline_ms is None:
            host.run(0.05)
            host.send(Stop())
        start = host.chip.cycle
        host.run(0.6)
        rises, widths = host.pulses()
        changes = np.abs(np.diff(widths, axis=0)).max(axis=1)
        changed = np.flatnonzero(changes > CYCLES_A_COUNT) + 1
        found.append(1e3 * max(int(rises[changed[-1], 0]) - start, 0) / CLOCK_HZ)
        if deadline_ms is None:
            host.board.reset(ResetCause.POWER_ON)
            host.arm()
    return found


def reset_ms() -> float:
    """From a hang to the watchdog's reset."""
    host = armed()
    start = host.chip.cycle
    host.chip.hang(False)
    while not host.chip.watchdog_resets:
        host.run(TICK)
    return 1e3 * (host.chip.cycle - start) / CLOCK_HZ


def highest_rate() -> int:
    """Setpoints a second, in steps of 50, of which none is lost in two seconds."""
    rate = 400
    while True:
        host = armed()
        for _ in range(2 * rate):
            host.send(Setpoint(200, PARK))
            host.run(1 / rate)
        state = host.state()
        is_good = state.echo == host.sequence and not (state.refused or state.overruns)
        if not is_good or host.chip.lost_bytes or state.mode is not Mode.ARMED:
            return rate - 50
        rate += 50
        if 21 * rate * 10 > 250_000:
            return rate - 50


def main() -> None:
    """Prints the table."""
    stops, losses = stand_still_ms(None), stand_still_ms(100)
    rows = (
        ('pulse jitter over 60 s of traffic', f'{jitter_us():.2f} us'),
        ('setpoints without loss at 250000 baud', f'{highest_rate()} a second'),
        ('STOP to the last changed pulse', _span(stops)),
        ('link lost, deadline 100 ms, to the same', _span(losses)),
        ('hung program to reset', f'{reset_ms():.0f} ms'),
    )
    for name, value in rows:
        print(f'{name:42}{value}')


def _span(times: list[float]) -> str:
    return f'{np.median(times):.1f} ms, at most {max(times):.1f} ms'


if __name__ == '__main__':
    main()
