"""Building the board's program and its simulator with make, where the tools are."""

import hashlib
import os
import shutil
import subprocess
from pathlib import Path

from manipulator.errors import ManipulatorError

FIRMWARE = Path(__file__).resolve().parent.parent
SIMULATOR = FIRMWARE / 'build' / 'simulator'
TOOLS = ('make', 'avr-gcc', 'avr-objcopy', 'cc')
HEADER_OF_SIMAVR = Path('/usr/include/simavr/sim_avr.h')


class CannotBuild(ManipulatorError):
    """A tool is missing, or the compiler said no."""


def missing_tools() -> list[str]:
    """What must be installed before anything here works."""
    missing = [tool for tool in TOOLS if shutil.which(tool) is None]
    if not HEADER_OF_SIMAVR.exists():
        missing.append('libsimavr-dev')
    return missing


def simulator() -> Path:
    """The folder of chip.so and pty_chip, up to date."""
    _make('simulator')
    return SIMULATOR


def firmware(machine: str) -> Path:
    """The program of a machine file's board, up to date."""
    out = f'build/{Path(machine).stem}'
    _make(f'MACHINE={machine}', f'OUT={out}', f'{out}/firmware.elf')
    return FIRMWARE / out / 'firmware.elf'


def firmware_of_header(header: str) -> Path:
    """The program for a machine.h that no machine file stands behind."""
    out = f'build/header-{hashlib.sha256(header.encode()).hexdigest()[:12]}'
    machine_h = FIRMWARE / out / 'machine.h'
    if not machine_h.exists():
        machine_h.parent.mkdir(parents=True, exist_ok=True)
        machine_h.write_text(header)
    # -o: the header is as it shall be, whatever stands in config/.
    _make(f'OUT={out}', '-o', f'{out}/machine.h', f'{out}/firmware.elf')
    return FIRMWARE / out / 'firmware.elf'


def _make(*words: str) -> None:
    missing = missing_tools()
    if missing:
        raise CannotBuild(f'not installed: {", ".join(missing)} (docs/firmware.md)')
    command = ['make', '-s', '-C', str(FIRMWARE), *words]
    # A make above this one must not hand its options down.
    environment = {k: v for k, v in os.environ.items() if k not in ('MAKEFLAGS', 'MAKELEVEL')}
    done = subprocess.run(command, capture_output=True, text=True, check=False, env=environment)
    if done.returncode:
        raise CannotBuild(f'{" ".join(command)}:\n{done.stdout}{done.stderr}')
