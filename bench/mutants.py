"""Mutation testing: changes the code at one place after another and looks whether a test fails.

MODULE is a file or a pattern, by default those of bench/mutants.yaml. Each mutant runs in a
scratch copy of the tree, against the tests that cover its line and start no other program: the
quickest first, and one parametrisation of each before the others. Coverage is measured once;
`--coverage DIR` keeps it for the next run of the same code. A survivor needs a test, or an entry
in bench/mutants.yaml that says why no test can notice it.
"""

import argparse
import os
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree
from collections import Counter, defaultdict
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from itertools import accumulate
from pathlib import Path
from queue import SimpleQueue

import yaml
from coverage import CoverageData

from bench.mutations import Mutation, mutations

ROOT = Path(__file__).resolve().parents[1]
SETTINGS = yaml.safe_load((ROOT / 'bench' / 'mutants.yaml').read_text())
PYTEST = (sys.executable, '-m', 'pytest', '-q', '-p', 'no:cacheprovider', '--hypothesis-seed=0')
FAST = ('-m', 'not processes', '-k', 'not chip', '--ignore=test/firmware')
EQUIVALENT = {
    (module, row['before'], row['after']): row['reason']
    for module, rows in SETTINGS['equivalent'].items()
    for row in rows
}
OUTCOMES = ('killed', 'survived', 'not covered', 'equivalent')
PATIENCE, LOADING, BUSY = 4.0, 30.0, 8.0
"""How many times as long as before a mutant's tests may compute, and seconds besides; how many
times as long as they compute they may wait, as on a busy computer."""


@dataclass(frozen=True)
class Mutant:
    """A mutation of one module, and its line before and after it."""

    module: str
    mutation: Mutation
    texts: tuple[str, str]

    def __str__(self) -> str:
        return f'{self.module}:{self.mutation.line}: {self.texts[0]}  →  {self.texts[1]}'


class Tests:
    """Which tests run a line, and how long each takes, measured in one run of them all."""

    def __init__(self, folder: Path, tree: Path, modules: list[str], jobs: int) -> None:
        if not (folder / 'data').exists():
            folder.mkdir(parents=True, exist_ok=True)
            rooms = sorted({f'--cov={module.split("/")[0]}' for module in modules})
            options = ['--cov-context=test', '--cov-report=', '-n', str(jobs), '--dist=loadfile']
            report = ['-o', 'junit_family=xunit1', f'--junitxml={folder}/times.xml']
            run([*PYTEST, *FAST, *rooms, *options, *report], tree, 3600.0)
            shutil.move(tree / '.coverage', folder / 'data')
        self._data = CoverageData(str(folder / 'data'))
        self._data.read()
        self._seconds = {
            f'{case.get("file")}::{case.get("name")}': float(case.get('time', 0.0))
            for case in ElementTree.parse(folder / 'times.xml').iter('testcase')
            if not len(case)  # neither skipped nor failed
        }
        if run([*PYTEST, '--collect-only', *self._seconds], tree, 600.0) != 0:
            raise SystemExit(f'tests that {folder} names are not there: measure coverage again')

    def covering(self, mutant: Mutant) -> list[str]:
        """Those that run the mutant's line; of a line that runs at import, all of its module."""
        files = self._data.measured_files()
        file = next((file for file in files if file.endswith(f'/{mutant.module}')), '')
        by_line = self._data.contexts_by_lineno(file)
        at = by_line.get(mutant.mutation.line) or by_line.get(mutant.mutation.statement) or []
        if at == ['']:
            at = [context for contexts in by_line.values() for context in contexts]
        names = {context.split('|')[0] for context in at} & self._seconds.keys()
        return sorted(names, key=self._seconds.__getitem__)

    def portions(
        self, mutant: Mutant, count: int, seconds: float
    ) -> list[tuple[list[str], float]]:
        """The first `count` and the others, each with its seconds: not above `seconds` in all."""
        seen: Counter[str] = Counter()
        turns: list[tuple[int, float, str]] = []
        for name in self.covering(mutant):
            turns.append((seen[name.split('[')[0]], self._seconds[name], name))
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


def run(command: list[str], folder: Path, seconds: float) -> int | None:
    """The status of a command that sees the tree in `folder`, and may compute for some seconds.

    None where it waits for something that does not come.
    """
    alone = {'OMP_NUM_THREADS': '1', 'OPENBLAS_NUM_THREADS': '1', 'PYTHONDONTWRITEBYTECODE': '1'}
    environment = os.environ | alone | {'PYTHONPATH': str(folder)}
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


def copy_tree(folder: Path) -> Path:
    """What git tracks, and new files that it does not ignore; with compiled modules."""
    listed = subprocess.run(
        ['git', 'ls-files', '-z', '-co', '--exclude-standard'],
        cwd=ROOT, check=True, capture_output=True, text=True,
    )  # fmt: skip
    for name in filter(None, listed.stdout.split('\0')):
        if (ROOT / name).is_file():
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(ROOT / name, folder / name)
    subprocess.run([sys.executable, '-m', 'compileall', '-q', '.'], cwd=folder, check=True)
    return folder


def sampled(patterns: list[str], count: int, seed: int) -> list[Mutant]:
    """From every module about as many, at random places."""
    named = {pattern: list(ROOT.glob(pattern)) for pattern in patterns}
    missing = [pattern for pattern, paths in named.items() if not paths]
    if missing:
        raise SystemExit(f'no module is called {", ".join(missing)}')
    paths, found = sorted({path for paths in named.values() for path in paths}), []
    for path in paths:
        source, module = path.read_bytes(), path.relative_to(ROOT).as_posix()
        ours = [Mutant(module, m, m.texts(source)) for m in mutations(source)]
        random.Random(f'{seed} {module}').shuffle(ours)
        found += list(enumerate(ours))
    found.sort(key=lambda turn: turn[0])
    return sorted((m for _, m in found[:count]), key=lambda m: (m.module, m.mutation.start))


class Laboratory:
    """Scratch copies of the tree, in which mutants are tried, one at a time in each."""

    def __init__(self, trees: list[Path], tests: Tests, most_tests: int, seconds: float) -> None:
        self._free: SimpleQueue[Path] = SimpleQueue()
        for tree in trees:
            self._free.put(tree)
        self._tests, self._most, self._seconds = tests, most_tests, seconds

    def outcome(self, mutant: Mutant) -> str:
        """One of OUTCOMES; a module that does not load, or never ends, is killed."""
        if (mutant.module, *mutant.texts) in EQUIVALENT:
            return 'equivalent'
        portions = self._tests.portions(mutant, self._most, self._seconds)
        if not portions:
            return 'not covered'
        tree = self._free.get()
        file = tree / mutant.module
        source = file.read_bytes()
        try:
            file.write_bytes(mutant.mutation.applied(source))
            for compiled in file.parent.glob(f'__pycache__/{file.stem}.*'):
                compiled.unlink()
            for names, needed in portions:
                if run([*PYTEST, '-x', *names], tree, PATIENCE * needed + LOADING) != 0:
                    return 'killed'
        finally:
            file.write_bytes(source)
            self._free.put(tree)
        return 'survived'


def report(outcomes: list[tuple[Mutant, str]]) -> None:
    """The table by module, then what survived and what is known to be the same."""
    table: dict[str, Counter[str]] = defaultdict(Counter)
    for mutant, outcome in outcomes:
        table[mutant.module][outcome] += 1
        table['all'][outcome] += 1
    total = table.pop('all')
    print('| module | ' + ' | '.join(OUTCOMES) + ' |\n|---|' + '---|' * len(OUTCOMES))
    for module, counts in [*sorted(table.items()), ('all', total)]:
        print(f'| {module} | ' + ' | '.join(str(counts[o]) for o in OUTCOMES) + ' |')
    for outcome in ('survived', 'not covered', 'equivalent'):
        print(f'\n{outcome}:')
        for mutant, found in outcomes:
            if found == outcome:
                reason = EQUIVALENT.get((mutant.module, *mutant.texts), '')
                print(f'  {mutant}' + (f'  ({reason})' if reason else ''))


def main(arguments: list[str]) -> None:
    parser = argparse.ArgumentParser(prog='python -m bench.mutants', description=__doc__)
    parser.add_argument('modules', nargs='*', metavar='MODULE', default=SETTINGS['modules'])
    parser.add_argument('--count', type=int, default=300, help='mutants')
    parser.add_argument('--seed', type=int, default=1)
    parser.add_argument('--tests', type=int, default=40, help='asked first, before all others')
    parser.add_argument(
        '--seconds', type=float, default=30.0, help='of tests for a mutant, at most'
    )
    parser.add_argument('--jobs', type=int, default=2, help='mutants at a time')
    parser.add_argument('--coverage', type=Path, metavar='DIR', help='where coverage is kept')
    options = parser.parse_args(arguments)
    mutants = sampled(options.modules, options.count, options.seed)
    with tempfile.TemporaryDirectory(prefix='hexarm_mutants_') as scratch:
        trees = [copy_tree(Path(scratch) / f'tree_{k}') for k in range(options.jobs)]
        folder = options.coverage or Path(scratch) / 'coverage'
        tests = Tests(folder.absolute(), trees[0], [m.module for m in mutants], options.jobs)
        laboratory = Laboratory(trees, tests, options.tests, options.seconds)
        with ThreadPoolExecutor(options.jobs) as pool:
            outcomes = []
            for mutant, found in zip(mutants, pool.map(laboratory.outcome, mutants), strict=True):
                outcomes.append((mutant, found))
                print(f'{len(outcomes)}/{len(mutants)} {found}: {mutant}', file=sys.stderr)
    report(outcomes)


if __name__ == '__main__':
    main(sys.argv[1:])
