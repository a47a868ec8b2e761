"""`hexarm firmware-header`: what the board's program takes from a machine file, as a C header."""

import argparse
import ctypes
from pathlib import Path

from bridge.calibration import Calibration
from bridge.fake.board_settings import BoardSettings
from bridge.protocol import MAX_JOINTS
from bridge.servo_config import BoardConfig
from hexarm import machines
from hexarm.board.kinematics import crank_hexapod
from hexarm.board.table import flash_header, read_table
from manipulator.errors import ConfigError

WIDEST_COUNT = 36_000
"""18 ms: a wider pulse would still be in progress when the board prepares the next one."""
CHANNELS = 8
"""Pulses that the chip makes, MAX_JOINTS of its program: firmware/Makefile, avr/pulses.c."""
BAUD_STEP, WORST_BAUD = 2_000_000, 0.025
"""Bits per second at the chip's fastest; 115200 is 2.1 % off, and still understood."""
HIGHEST_BATTERY_MV = 9_990
BOOT_S = 0.0
A_MACHINE = "a machine's settings"


def add_parser(commands: 'argparse._SubParsersAction[argparse.ArgumentParser]') -> None:
    """Declares the subcommand."""
    parser = commands.add_parser('firmware-header')
    parser.add_argument('machine', help='a shipped name or a path')
    parser.add_argument('--table', type=Path, help='a CSV of joint positions, for flash_table.h')
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    """Prints parameters.h, or flash_table.h where a table is given."""
    if arguments.table is None:
        print(header_of(arguments.machine), end='')
    else:
        calibration = Calibration.from_config(_board_config(arguments.machine).servos)
        table = read_table(arguments.table, calibration)
        print(flash_header(table, arguments.table.name, calibration), end='')
    return 0


def header_of(machine: str) -> str:
    """parameters.h of a machine file; ConfigError where the machine does not fit the board."""
    return header(settings_of(machine), machines.find(machine).name)


def settings_of(machine: str) -> BoardSettings:
    """What the board has from a machine file; it starts at once."""
    config = _board_config(machine)
    calibration = Calibration.from_config(config.servos)
    hexapod = crank_hexapod(machines.load(machine), calibration)
    return BoardSettings.from_config(config, BOOT_S, hexapod)


def _board_config(machine: str) -> BoardConfig:
    return BoardConfig.from_machine(machines.read(machine), str(machines.find(machine)))


def header(settings: BoardSettings, name: str = A_MACHINE) -> str:
    """parameters.h: the program's structure of its machine (firmware/core/machine.h)."""
    _refuse_joints(settings)
    _refuse_wide_pulses(settings)
    _refuse_baud(settings.baud)
    _refuse_battery(settings)
    top = f'/* Made by `hexarm firmware-header` from {name}: change that file instead. */'
    fields = ''.join(f'    {field}, \\\n' for field in _fields(settings.machine))
    return f'{top}\n#pragma once\n\n#define MACHINE_PARAMETERS {{ \\\n{fields}}}\n'


def _fields(structure: ctypes.Structure) -> list[str]:
    """Each field by its name, so that the compiler notices one that is called otherwise."""
    names = (field[0] for field in structure._fields_)
    return [f'.{name} = {_initialiser(getattr(structure, name))}' for name in names]


def _initialiser(value: object) -> str:
    """In C; floats to the last bit."""
    if isinstance(value, ctypes.Structure):
        return f'{{{", ".join(_fields(value))}}}'
    if isinstance(value, ctypes.Array):
        numbers = value[:CHANNELS] if len(value) == MAX_JOINTS else value
        return f'{{{", ".join(map(_initialiser, numbers))}}}'
    if isinstance(value, float):
        return f'{value:.9e}f'
    return str(value).lower()


def _refuse_wide_pulses(settings: BoardSettings) -> None:
    for channel, (_, high) in enumerate(settings.count_ranges):
        if high > WIDEST_COUNT:
            raise ConfigError(
                [
                    f'servos: the pulses of channel {channel} reach {high / 2:g} us, '
                    f'the board makes at most {WIDEST_COUNT / 2:g} us'
                ]
            )


def _refuse_baud(baud: int) -> None:
    """The chip divides its crystal by 8 and a whole number."""
    made = BAUD_STEP / max(round(BAUD_STEP / baud), 1)
    if abs(made / baud - 1) > WORST_BAUD:
        nearest = f'the board makes {made:.0f} instead'
        raise ConfigError([f'link.baud: {baud} bit/s; {nearest}, 250000 is exact'])


def _refuse_joints(settings: BoardSettings) -> None:
    count = len(settings.count_ranges)
    if count > CHANNELS:
        raise ConfigError([f'servos.joints: {count} joints, the board has {CHANNELS} channels'])


def _refuse_battery(settings: BoardSettings) -> None:
    if settings.minimum_battery_mv >= HIGHEST_BATTERY_MV:
        raise ConfigError(
            [
                f'servos.minimum_battery_v: {settings.minimum_battery_mv / 1000:g} V, the board '
                f'measures below {HIGHEST_BATTERY_MV / 1000:g} V and would never arm'
            ]
        )
