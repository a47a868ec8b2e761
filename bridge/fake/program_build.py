"""Builds the board's program for this computer: one shared library from firmware/core and host/.

Imports nothing of ours: setup.py runs it too.
"""

import importlib.util
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
FIRMWARE = HERE.parents[1] / 'firmware'
LIBRARY = HERE / 'board_program.so'
"""Where it belongs, in the source tree as well as where hexarm is installed."""

FOLDERS = ('core', 'host')
FLAGS = (
    *('-std=c11', '-O2', '-fPIC', '-shared', '-ffp-contract=off'),
    *('-Wall', '-Wextra', '-Wconversion', '-Wshadow', '-Werror'),
)


class CannotCompile(RuntimeError):
    """There is no compiler, or it refused."""


def sources(firmware: Path = FIRMWARE) -> list[Path]:
    """The C files, in a source tree."""
    return [file for folder in FOLDERS for file in sorted((firmware / folder).glob('*.c'))]


def compiler() -> list[str]:
    """The system's, or the one that comes as the Python package ziglang."""
    for own in (os.environ.get('CC', ''), 'cc', 'gcc', 'clang'):
        if own and shutil.which(own.split()[0]):
            return own.split()
    if importlib.util.find_spec('ziglang') is not None:
        return [sys.executable, '-m', 'ziglang', 'cc']
    raise CannotCompile("no C compiler: install gcc or clang, or the Python package 'ziglang'")


def build(output: Path = LIBRARY, firmware: Path = FIRMWARE) -> None:
    """Compiles the library; whoever opens it meanwhile sees the old or the new one, whole."""
    with tempfile.NamedTemporaryFile(dir=output.parent, suffix='.so', delete=False) as file:
        made = Path(file.name)
    includes = [f'-I{firmware / folder}' for folder in FOLDERS]
    files = [*map(str, sources(firmware)), '-lm']
    command = [*compiler(), *FLAGS, *includes, '-o', str(made), *files]
    try:
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if done.returncode:
            raise CannotCompile(f'{" ".join(command)}:\n{done.stderr}')
        made.chmod(0o755)
        made.replace(output)
    finally:
        made.unlink(missing_ok=True)


def is_stale(output: Path = LIBRARY, firmware: Path = FIRMWARE) -> bool:
    """A source is newer than the library; never where there are no sources."""
    headers = (file for folder in FOLDERS for file in (firmware / folder).glob('*.h'))
    times = [file.stat().st_mtime for file in (*sources(firmware), *headers)]
    return bool(times) and (not output.exists() or output.stat().st_mtime < max(times))


if __name__ == '__main__':
    build()
