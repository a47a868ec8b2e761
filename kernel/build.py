"""Builds the kernel: the compiler's call, and what pip asks of a build backend (PEP 517).

The library is a Python module of the stable ABI, so that one file serves every Python from 3.10
on, and none of Python's headers are needed. Where the system has no C compiler, pip installs one
for the build, from the package `ziglang`.
"""

import shutil
import subprocess
import sys
from pathlib import Path

from setuptools import build_meta
from setuptools.build_meta import *  # noqa: F403  the hooks that stay as they are

SOURCES = Path(__file__).parent
FLAGS = ['-std=c11', '-O3', '-fno-math-errno', '-fno-trapping-math', '-fPIC', '-shared']
FLAGS += ['-fvisibility=hidden']


def compiler() -> list[str]:
    """The command of the C compiler: the system's, else that of `ziglang`."""
    found = next(filter(shutil.which, ('cc', 'gcc', 'clang')), None)
    return [found] if found else [sys.executable, '-m', 'ziglang', 'cc']


def build(output: Path) -> None:
    """Compiles the kernel into a file; SystemExit with what to install where that fails."""
    output.parent.mkdir(parents=True, exist_ok=True)
    sources = sorted(str(source) for source in SOURCES.glob('*.c'))
    command = [*compiler(), *FLAGS, *sources, '-lm', '-o', str(output)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode:
        print(done.stderr, file=sys.stderr)
        raise SystemExit(
            f'hexarm: its C library did not compile with {" ".join(compiler())!r} (see above): '
            'install a C compiler (Debian, Ubuntu: apt install gcc) and try again'
        )


def _with_compiler(requirements: list[str]) -> list[str]:
    return [*requirements, 'ziglang>=0.13'] if 'ziglang' in compiler() else requirements


def get_requires_for_build_wheel(config_settings: object = None) -> list[str]:
    """What building a wheel needs."""
    return _with_compiler(build_meta.get_requires_for_build_wheel(config_settings))


def get_requires_for_build_editable(config_settings: object = None) -> list[str]:
    """What an editable installation needs."""
    return _with_compiler(build_meta.get_requires_for_build_editable(config_settings))
