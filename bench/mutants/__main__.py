"""Mutation testing: changes the code at one place after another and looks whether a test fails.

MODULE is a file or a pattern, by default those of bench/mutants/settings.yaml, Python or C. Each
mutant runs in a scratch copy of the tree, with libraries built anew for one of C, against the
tests that cover its line and start no other program: the quickest first, and one parametrisation
of each before the others. Coverage is measured once; `--coverage DIR` keeps it for the next run of
the same code. A survivor needs a test, or an entry in settings.yaml that says why no test can
notice it.
"""

import argparse
import random
import shutil
import subprocess
import sys
import tempfile
from collections import Counter, defaultdict
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from pathlib import Path
from queue import SimpleQueue

import yaml

from bench.mutants import of_c, of_python
from bench.mutants.libraries import LIBRARIES, build, built_files, library_file
from bench.mutants.tests import PYTEST, Mutant, Tests, run

FOLDER = Path(__file__).resolve().parent
ROOT = FOLDER.parents[1]
SETTINGS = yaml.safe_load((FOLDER / 'settings.yaml').read_text())
EQUIVALENT = {
    (module, row['before'], row['after']): row['reason']
    for module, rows in SETTINGS['equivalent'].items()
    for row in rows
}
OUTCOMES = ('killed', 'survived', 'not covered', 'equivalent', 'does not compile')
SAME = 'compiled to the same program'
PATIENCE, LOADING = 4.0, 30.0
"""How many times as long as before a mutant's tests may compute, and seconds besides."""


def copy_tree(folder: Path) -> Path:
    """What git tracks, and new files that it does not ignore; with compiled modules, C as well."""
    listed = subprocess.run(
        ['git', 'ls-files', '-z', '-co', '--exclude-standard'],
        cwd=ROOT, check=True, capture_output=True, text=True,
    )  # fmt: skip
    for name in filter(None, listed.stdout.split('\0')):
        if (ROOT / name).is_file():
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(ROOT / name, folder / name)
    subprocess.run([sys.executable, '-m', 'compileall', '-q', '.'], cwd=folder, check=True)
    if not all(build(folder, name) for name in LIBRARIES):
        raise SystemExit('the C libraries do not compile')
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
        language = of_python if path.suffix == '.py' else of_c
        ours = [Mutant(module, m, m.texts(source)) for m in language.mutations(source)]
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
        try:
            with applied(mutant, tree):
                return self._tried(mutant, tree, portions)
        finally:
            self._free.put(tree)

    def _tried(self, mutant: Mutant, tree: Path, portions: list[tuple[list[str], float]]) -> str:
        before = [library_file(tree, name).read_bytes() for name in mutant.libraries]
        if not all(build(tree, name, mutant.module) for name in mutant.libraries):
            return 'does not compile'
        after = [library_file(tree, name).read_bytes() for name in mutant.libraries]
        if mutant.libraries and before == after:
            return 'equivalent'
        for names, needed in portions:
            if run([*PYTEST, '-x', *names], tree, PATIENCE * needed + LOADING) != 0:
                return 'killed'
        return 'survived'


@contextmanager
def applied(mutant: Mutant, tree: Path) -> Iterator[None]:
    """Within, the tree has the change, though libraries are as before until they are built."""
    built = [file for name in mutant.libraries for file in built_files(tree, name)]
    files = [tree / mutant.module, *built]
    contents = [file.read_bytes() for file in files]
    try:
        files[0].write_bytes(mutant.mutation.applied(contents[0]))
        for compiled in files[0].parent.glob(f'__pycache__/{files[0].stem}.*'):
            compiled.unlink()
        yield
    finally:
        for file, content in zip(files, contents, strict=True):
            file.write_bytes(content)


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
                reason = EQUIVALENT.get((mutant.module, *mutant.texts), SAME)
                print(f'  {mutant}' + (f'  ({reason})' if outcome == 'equivalent' else ''))


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
    parser.add_argument('--only', type=Path, metavar='FILE', help='those that a report names')
    parser.add_argument('--coverage', type=Path, metavar='DIR', help='where coverage is kept')
    options = parser.parse_args(arguments)
    mutants = sampled(options.modules, options.count, options.seed)
    if options.only:
        named = options.only.read_text()
        mutants = [mutant for mutant in mutants if str(mutant) in named]
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
