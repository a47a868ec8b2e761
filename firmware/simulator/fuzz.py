"""Noise, damaged, cut and senseless frames: none may move a servo or stall the link.

`make -C firmware soak` sends ten megabytes of them.
"""

import random
import sys
import time
from collections.abc import Iterator

from bridge import cobs
from bridge.frames import DELIMITER, checksum, encode
from bridge.protocol import Arm, Clear, Disarm, Mode, Play, Program, Setpoint, Stop, TableRow
from firmware.simulator.host import PARK, Host

FAR = (4800, 1200, 4800, 1200, 4800, 1200)
SEQUENCE = 40_000
COMMANDS = (Arm(FAR), Disarm(), Stop(), Clear(), TableRow(0, FAR), Play(Program.TABLE, True))
HONEST = [encode(m, SEQUENCE) for m in (Setpoint(200, FAR), *COMMANDS)]
FIRST_UNUSED_TYPE = 0x20
MUTANTS_A_ROUND = 400
STEP = 0.02


class Moved(AssertionError):
    """Garbage did something."""


def mutants(rng: random.Random, count: int) -> Iterator[bytes]:
    """Bytes that no honest host sends."""
    for _ in range(count):
        yield rng.choice((_noise, _damaged, _cut, _senseless))(rng)


def fuzz(host: Host, seed: int, size: int) -> int:
    """Sends at least `size` bytes to an armed board; how many it were. Moved gives the reason.

    Between the rounds an honest setpoint must get through, and all pulses are the ones at park.
    """
    rng = random.Random(seed)
    sent = 0
    while sent < size:
        garbage = b''.join(mutants(rng, MUTANTS_A_ROUND))
        sent += len(garbage)
        host.board.feed(garbage + DELIMITER)
        while host.board.backlog:
            host.run(STEP)
        host.send(Setpoint(200, PARK))
        state = host.state()
        if state.echo != host.sequence or state.mode is not Mode.ARMED:
            raise Moved(f'after {sent} bytes the link is stalled: {state}')
        if set(host.pulse_counts()) != {PARK} or host.chip.watchdog_resets:
            raise Moved(f'after {sent} bytes the pulses are no longer those at park')
    return sent


def main() -> None:
    """Ten megabytes, or as many as the command line says."""
    size = int(float(sys.argv[1]) * 1e6) if len(sys.argv) > 1 else 10_000_000
    host = Host()
    host.arm()
    start = time.monotonic()
    sent = fuzz(host, seed=1, size=size)
    state = host.state()
    print(
        f'{sent} bytes of garbage in {host.chip.seconds:.0f} s of the chip '
        f'({time.monotonic() - start:.0f} s here): nothing moved, no setpoint lost; '
        f'{state.bad_frames} damaged, {state.overruns} too long, {state.refused} refused '
        f'(the counters stop at 65535)'
    )


def _noise(rng: random.Random) -> bytes:
    return rng.randbytes(rng.randrange(1, 90))


def _damaged(rng: random.Random) -> bytes:
    honest = rng.choice(HONEST)
    frame = bytearray(honest)
    while frame == honest:
        for _ in range(rng.randrange(1, 4)):
            frame[rng.randrange(len(frame))] ^= rng.randrange(1, 256)
    return bytes(frame)


def _cut(rng: random.Random) -> bytes:
    frame = rng.choice(HONEST)
    return frame[: rng.randrange(len(frame) - 1)] + DELIMITER


def _senseless(rng: random.Random) -> bytes:
    """A whole frame, CRC and all, of a type that no host sends."""
    body = bytes([rng.randrange(FIRST_UNUSED_TYPE, 256)]) + rng.randbytes(rng.randrange(2, 50))
    return cobs.encode(body + checksum(body).to_bytes(2, 'little')) + DELIMITER


if __name__ == '__main__':
    main()
