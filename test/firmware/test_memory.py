"""The stack never meets the variables, whatever the board does."""

import dataclasses
import random

from bridge.protocol import Arm, CycleAxis, Mode, Play, Program, Setpoint
from firmware.simulator.fuzz import mutants
from firmware.simulator.host import SETTINGS, Host
from hexarm.board import build as firmware_build
from hexarm.board.header import header_of, settings_of

RAM_START, RAM_END = 0x200, 0x21FF
PAINT = 0xC5


def test_the_stack_leaves_a_quarter_of_its_room_free(tools):
    host = Host(dataclasses.replace(SETTINGS, hexapod=settings_of('robocake').hexapod))
    variables = firmware_build.sizes(firmware_build.firmware(header_of('robocake'))).ram
    bottom = RAM_START + variables + 16
    for address in range(bottom, RAM_END + 1):
        host.chip.poke(address, PAINT)
    host.run(0.1)
    host.ask(Arm((3000,) * 6))
    host.run(0.3)
    rng = random.Random(2)
    host.send(Setpoint(100, (4000,) * 6))
    host.board.feed(b''.join(mutants(rng, 200)) + b'\0')
    host.run(1.0)
    host.send(Setpoint(100, (3000,) * 6))
    host.run(1.0)
    host.ask(CycleAxis(5, 0.05, 1000, 0.0))
    host.ask(Play(Program.CYCLE, True))
    host.board.feed(b''.join(mutants(rng, 400)) + b'\0')
    host.run(4.0)
    assert host.state().mode is Mode.PLAYING
    untouched = next(k for k in range(RAM_END) if host.chip.peek(bottom + k) != PAINT)
    room = RAM_END + 1 - bottom
    assert host.chip.watchdog_resets == 0
    assert room / 4 <= untouched < room
