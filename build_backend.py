"""Builds the two C libraries: the compiler's calls, and what pip asks of a backend (PEP 517).

Neither needs Python's headers, so that each is one file for every Python from 3.10 on: the kernel
is a Python module of the stable ABI, the board's program is opened by ctypes. Where the system has
no C compiler, pip installs one for the build, from the package `ziglang`.
"""

import shutil
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

from setuptools import build_meta
from setuptools.build_meta import *  # noqa: F403  the hooks that stay as they are

ROOT = Path(__file__).parent
FLAGS = ('-std=c11', '-fPIC', '-shared')


@dataclass(frozen=True)
class Library:
    """Folders of C files below the root, and flags of their own."""

    folders: tuple[str, ...]
    flags: tuple[str, ...]

    def files(self, pattern: str) -> list[str]:
        """Paths from the root, sorted."""
        found = (path for folder in self.folders for path in (ROOT / folder).glob(pattern))
        return sorted(str(path.relative_to(ROOT)) for path in found)


LIBRARIES = {
    'manipulator._kernel': Library(
        ('kernel',), ('-O3', '-fno-math-errno', '-fno-trapping-math', '-fvisibility=hidden')
    ),
    'bridge._board': Library(('firmware/core', 'firmware/host'), ('-O2', '-ffp-contract=off')),
}


def compiler() -> list[str]:
    """The command of the C compiler: the system's, else that of `ziglang`."""
    found = next(filter(shutil.which, ('cc', 'gcc', 'clang')), None)
    return [found] if found else [sys.executable, '-m', 'ziglang', 'cc']


def build(name: str, output: Path) -> None:
    """Compiles a library into a file; SystemExit with what to install where that fails."""
    library = LIBRARIES[name]
    output.parent.mkdir(parents=True, exist_ok=True)
    includes = [f'-I{folder}' for folder in library.folders]
    command = [*compiler(), *FLAGS, *library.flags, *includes, *library.files('*.c')]
    command += ['-lm', '-o', str(output.absolute())]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    if done.returncode:
        print(done.stderr, file=sys.stderr)
        raise SystemExit(
            f'hexarm: the library {name} did not compile with {" ".join(compiler())!r} (see '
            'above): install a C compiler (Debian, Ubuntu: apt install gcc) and try again'
        )


def _with_compiler(requirements: list[str]) -> list[str]:
    return [*requirements, 'ziglang>=0.13'] if 'ziglang' in compiler() else requirements


def get_requires_for_build_wheel(config_settings: object = None) -> list[str]:
    """What building a wheel needs."""
    return _with_compiler(build_meta.get_requires_for_build_wheel(config_settings))


def get_requires_for_build_editable(config_settings: object = None) -> list[str]:
    """What an editable installation needs."""
    return _with_compiler(build_meta.get_requires_for_build_editable(config_settings))
