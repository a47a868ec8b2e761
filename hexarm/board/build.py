"""Building the board's program and its simulated chip with make, where the tools are."""

import contextlib
import fcntl
import hashlib
import json
import os
import shutil
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from hexarm.board.header import header, settings_of
from manipulator.errors import ManipulatorError

FIRMWARE = Path(__file__).resolve().parents[2] / 'firmware'
TOOLS = ('make', 'avr-gcc', 'avr-objcopy', 'avr-size', 'cc')
HEADER_OF_SIMAVR = Path('/usr/include/simavr/sim_avr.h')


@dataclass(frozen=True)
class Sizes:
    """Bytes of a program on the chip; `ram` without the stack."""

    flash: int
    ram: int


class CannotBuild(ManipulatorError):
    """A tool is missing, or the compiler failed."""


def missing_tools() -> list[str]:
    """What must be there before anything here works."""
    if not FIRMWARE.is_dir():
        return ['the source tree of hexarm']
    missing = [tool for tool in TOOLS if shutil.which(tool) is None]
    if not HEADER_OF_SIMAVR.exists():
        missing.append('libsimavr-dev')
    return missing


def simulator() -> Path:
    """The folder of chip.so, up to date."""
    with _alone():
        _make('simulator')
    return FIRMWARE / 'build' / 'simulator'


def firmware(header: str, flash_table: str = '') -> Path:
    """The program for a parameters.h, and a flash_table.h if it has one, up to date."""
    return _built('firmware.elf', {'parameters.h': header, 'flash_table.h': flash_table})


def bench(header: str) -> Path:
    """The program that marks how long the kinematics take."""
    return _built('bench.elf', {'parameters.h': header})


def chip_command(machine: str) -> tuple[str, ...]:
    """What runs fake_hardware with a machine's board on a simulated chip; builds both first."""
    firmware(header(settings_of(machine)))
    simulator()
    return sys.executable, '-m', 'firmware.simulator.node'


def step_times() -> dict[str, float]:
    """How long one call takes on the simulated chip at most, in ms, by what is called."""
    command = [sys.executable, '-m', 'firmware.simulator.cycles', '--json']
    done = subprocess.run(
        command, capture_output=True, text=True, check=False, cwd=FIRMWARE.parent
    )
    if done.returncode:
        raise CannotBuild(f'{" ".join(command)}:\n{done.stderr}')
    return dict(json.loads(done.stdout))


def sizes(program: Path) -> Sizes:
    """How much of the chip a program takes."""
    command = ['avr-size', '-A', str(program)]
    table = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    rows = (line.split() for line in table.splitlines() if line.startswith('.'))
    size = {name: int(number) for name, number, _ in rows}
    variables = size['.bss'] + size.get('.noinit', 0)
    return Sizes(size['.text'] + size['.data'], size['.data'] + variables)


def _built(what: str, headers: dict[str, str]) -> Path:
    """A file made with these headers, in a folder of its own: machines never mix."""
    headers = {name: text for name, text in headers.items() if text}
    out = f'build/{hashlib.sha256(repr(headers).encode()).hexdigest()[:12]}'
    words = ['TABLE=given'] if 'flash_table.h' in headers else []
    with _alone():
        for name, text in headers.items():
            path = FIRMWARE / out / name
            if not path.exists():
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_text(text)
            words += ['-o', f'{out}/{name}']  # as it shall be, whatever stands in config/
        _make(f'OUT={out}', *words, f'{out}/{what}')
    return FIRMWARE / out / what


@contextlib.contextmanager
def _alone() -> Iterator[None]:
    """While no other process builds: make would write a file that another is about to load."""
    missing = missing_tools()
    if missing:
        raise CannotBuild(f'not there: {", ".join(missing)} (docs/firmware.md)')
    folder = FIRMWARE / 'build'
    folder.mkdir(exist_ok=True)
    with (folder / '.lock').open('w') as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        yield


def _make(*words: str) -> None:
    command = ['make', '-s', '-C', str(FIRMWARE), f'PYTHON={sys.executable}', *words]
    # A make above this one must not hand its options down.
    environment = {k: v for k, v in os.environ.items() if k not in ('MAKEFLAGS', 'MAKELEVEL')}
    done = subprocess.run(command, capture_output=True, text=True, check=False, env=environment)
    if done.returncode:
        raise CannotBuild(f'{" ".join(command)}:\n{done.stdout}{done.stderr}')
