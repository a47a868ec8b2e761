"""Which tests run a line of the code, and how long each takes, measured in one run of them all."""

import json
import os
import re
import shutil
import signal
import subprocess
import sys
import xml.etree.ElementTree as ElementTree
from collections import Counter, defaultdict
from collections.abc import Mapping
from dataclasses import dataclass
from itertools import accumulate
from pathlib import Path

from coverage import CoverageData

from bench.mutants.libraries import LIBRARIES, build_traced, library_file
from bench.mutants.mutation import Mutation

PYTEST = (sys.executable, '-m', 'pytest', '-q', '-p', 'no:cacheprovider', '--hypothesis-seed=0')
FAST = ('-m', 'not processes', '-k', 'not chip', '--ignore=test/firmware')
COMPILED, NOT_COMPILED = {'PYTHONDONTWRITEBYTECODE': ''}, {'PYTHONDONTWRITEBYTECODE': '1'}
"""A tree's tests are compiled once; a mutant leaves nothing behind."""

BUSY = 8.0
"""How many times as long as they compute tests may wait, as on a busy computer."""


@dataclass(frozen=True)
class Mutant:
    """A mutation of one file, and its line before and after it."""

    module: str
    mutation: Mutation
    texts: tuple[str, str]

    @property
    def libraries(self) -> tuple[str, ...]:
        """Those that are built of a C file: the board shares the kernel's cranks."""
        if self.module.endswith('.py'):
            return ()
        if self.module.startswith('firmware/'):
            return ('board',)
        is_shared = self.module.endswith(('.h', '/crank.c'))
        return ('kernel', 'board') if is_shared else ('kernel',)

    def __str__(self) -> str:
        return f'{self.module}:{self.mutation.line}: {self.texts[0]}  →  {self.texts[1]}'


class Tests:
    """Those that start no other program; `folder` keeps what is measured."""

    def __init__(self, folder: Path, tree: Path, modules: list[str], jobs: int) -> None:
        if not (folder / 'data').exists():
            folder.mkdir(parents=True, exist_ok=True)
            _measure(folder, tree, modules, jobs)
        self._data = CoverageData(str(folder / 'data'))
        self._data.read()
        self._c_lines = json.loads((folder / 'c_lines.json').read_text())
        self._seconds = {
            f'{case.get("file")}::{case.get("name")}': float(case.get('time', 0.0))
            for case in ElementTree.parse(folder / 'times.xml').iter('testcase')
            if not len(case)  # neither skipped nor failed
        }
        if run([*PYTEST, '--collect-only', *self._seconds], tree, 600.0, COMPILED) != 0:
            raise SystemExit(f'tests that {folder} names are not there: measure coverage again')

    def covering(self, mutant: Mutant) -> list[str]:
        """Those that run the mutant's line; of a line that runs at import, all of its module."""
        names = self._on_c_line(mutant) if mutant.libraries else self._on_python_line(mutant)
        return sorted(names & self._seconds.keys(), key=self._seconds.__getitem__)

    def _on_python_line(self, mutant: Mutant) -> set[str]:
        files = self._data.measured_files()
        file = next((file for file in files if file.endswith(f'/{mutant.module}')), '')
        by_line = self._data.contexts_by_lineno(file)
        at = by_line.get(mutant.mutation.line) or by_line.get(mutant.mutation.statement) or []
        if at == ['']:
            at = [context for contexts in by_line.values() for context in contexts]
        return {context.split('|')[0] for context in at}

    def _on_c_line(self, mutant: Mutant) -> set[str]:
        """Of a line within a block, those on the block's first; of a file's first lines, all.

        Of a header that only declares: all of its library.
        """
        by_line = {int(line): at for line, at in self._c_lines.get(mutant.module, {}).items()}
        if not by_line and mutant.module.endswith('.h'):
            folder = mutant.module.rpartition('/')[0]
            lines_of = (lines for file, lines in self._c_lines.items() if file.startswith(folder))
            return {name for lines in lines_of for at in lines.values() for name in at}
        begun = [line for line in by_line if line <= mutant.mutation.line]
        lines = [max(begun)] if begun else list(by_line)
        return {name for line in lines for name in by_line[line]}

    def portions(
        self, mutant: Mutant, count: int, seconds: float
    ) -> list[tuple[list[str], float]]:
        """The first `count` and the others, each with its seconds: not above `seconds` in all.

        Those of a test file with the module's name come first, and of each test one of its runs.
        """
        seen: Counter[str] = Counter()
        own = f'/test_{Path(mutant.module).stem}'
        turns: list[tuple[tuple[bool, int], float, str]] = []
        for name in self.covering(mutant):
            order = own not in name, seen[name.split('[')[0]]
            turns.append((order, self._seconds[name], name))
            seen[name.split('[')[0]] += 1
        turns.sort()
        portions = []
        for part in (turns[:count], turns[count:]):
            totals = accumulate((needed for _, needed, _ in part), initial=0.0)
            names = [name for (_, _, name), t in zip(part, totals, strict=False) if t < seconds]
            needed = sum(self._seconds[name] for name in names)
            seconds -= needed
            portions.append((names, needed))
        return [portion for portion in portions if portion[0]]


def _measure(folder: Path, tree: Path, modules: list[str], jobs: int) -> None:
    """Coverage of both languages, with libraries of their own that are removed again."""
    built = {name: library_file(tree, name) for name in LIBRARIES}
    plain = {library: library.read_bytes() for library in built.values()}
    for name in LIBRARIES:
        build_traced(tree, name)
    rooms = sorted({f'--cov={m.split("/")[0]}' for m in modules if m.endswith('.py')})
    options = ['--cov-context=test', '--cov-report=', '-n', str(jobs), '--dist=loadfile']
    report = ['-o', 'junit_family=xunit1', f'--junitxml={folder}/times.xml']
    trace = ['-p', 'bench.mutants.traced_tests']
    os.environ['C_COVERAGE_RUN'] = str(folder / 'places')
    run([*PYTEST, *FAST, *trace, *rooms, *options, *report], tree, 3600.0)
    shutil.move(tree / '.coverage', folder / 'data')
    lines = {name: _lines_of(folder, tree, name, library) for name, library in built.items()}
    (folder / 'c_lines.json').write_text(json.dumps(_merged(lines.values())))
    for library, content in plain.items():
        library.write_bytes(content)


def _lines_of(folder: Path, tree: Path, name: str, library: Path) -> list[tuple[str, int, str]]:
    """(file, line, test), of every block that a test has begun."""
    tests: dict[int, set[str]] = defaultdict(set)
    for worker in (folder / 'places').glob('*/places.json'):
        for test, places in json.loads(worker.read_text())[name].items():
            for place in places:
                tests[place].add(test)
    places = sorted(tests)
    asked = subprocess.run(
        ['addr2line', '-e', str(library)], input='\n'.join(hex(place) for place in places),
        capture_output=True, text=True, check=True,
    )  # fmt: skip
    found = []
    for place, answer in zip(places, asked.stdout.splitlines(), strict=True):
        path, line = re.split(r':(?=\d|\?)', answer.split(' ')[0])
        if line.isdigit():
            file = os.path.relpath(path, tree)
            found += [(file, int(line), test) for test in tests[place]]
    return found


def _merged(found) -> dict[str, dict[int, list[str]]]:
    """Tests by file and line."""
    lines: dict[str, dict[int, set[str]]] = defaultdict(lambda: defaultdict(set))
    for library in found:
        for file, line, test in library:
            lines[file][line].add(test)
    return {f: {n: sorted(at) for n, at in by.items()} for f, by in lines.items()}


def run(
    command: list[str], folder: Path, seconds: float, variables: Mapping[str, str] = NOT_COMPILED
) -> int | None:
    """The status of a command that sees the tree in `folder`, and may compute for some seconds.

    None where it waits for something that does not come.
    """
    alone = {'OMP_NUM_THREADS': '1', 'OPENBLAS_NUM_THREADS': '1', 'PYTHONPATH': str(folder)}
    environment = {**os.environ, **alone, **variables}
    limited = ('sh', '-c', f'ulimit -t {round(seconds)}; exec nice "$@"', 'sh')
    with subprocess.Popen(
        [*limited, *command],
        cwd=folder,
        env=environment,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        start_new_session=True,
    ) as process:
        try:
            return process.wait(BUSY * seconds)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            return None
