"""The rows of one bench module; one that cannot be measured says why, and ends nothing."""

import ast
import importlib
import time
from dataclasses import dataclass
from pathlib import Path

from bench.row import Row

ROOM = Path(__file__).parent
EXTRA = "pip install 'hexarm[bench]'"


@dataclass(frozen=True)
class Section:
    """What a module measured, under the first line of its docstring, and the seconds it took."""

    name: str
    title: str
    rows: tuple[Row, ...]
    seconds: float


def names() -> list[str]:
    """The modules that measure something, other libraries last: `kinematics`, `peers.mink_arm`."""
    files = [*sorted(ROOM.glob('*.py')), *sorted(ROOM.glob('peers/*.py'))]
    found = ['.'.join(file.relative_to(ROOM).with_suffix('').parts) for file in files]
    return [name for name in found if _measures(_parsed(name))]


def measured(name: str) -> Section:
    """Runs one module; a library that is missing is a row, and so is a failure."""
    title = (ast.get_docstring(_parsed(name)) or name).splitlines()[0].rstrip('.')
    before = time.monotonic()
    try:
        rows = tuple(importlib.import_module(f'bench.{name}').rows())
    except ModuleNotFoundError as error:
        rows = (Row(f'{error.name} is not installed', EXTRA),)
    except Exception as error:  # noqa: BLE001 (the other sections are worth their time)
        rows = (Row('not measured', f'{type(error).__name__}: {error}', '', reached=False),)
    return Section(name, title, rows, time.monotonic() - before)


def _parsed(name: str) -> ast.Module:
    return ast.parse((ROOM / name.replace('.', '/')).with_suffix('.py').read_text())


def _measures(module: ast.Module) -> bool:
    return any(isinstance(part, ast.FunctionDef) and part.name == 'rows' for part in module.body)
