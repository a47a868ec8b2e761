"""The C libraries of a scratch copy of the tree: as the product is built, and traced."""

import subprocess
from pathlib import Path

import build_backend

LIBRARIES = {'kernel': 'manipulator._kernel', 'board': 'bridge._board'}
"""What traced_tests.py calls them, and build_backend.py."""

TRACED = ('-O1', '-g', '-fsanitize-coverage=trace-pc')


def library_file(tree: Path, name: str) -> Path:
    """Where a tree has a library."""
    return tree / f'{LIBRARIES[name].replace(".", "/")}.abi3.so'


def build(tree: Path, name: str, changed: str = '') -> bool:
    """Compiles the file that has changed since the last build, or all; whether it compiles."""
    library, compiler = build_backend.LIBRARIES[LIBRARIES[name]], build_backend.compiler()
    sources = library.files('*.c')
    objects = {source: _object(tree, name, source) for source in sources}
    for source in [changed] if changed in sources else sources:
        objects[source].parent.mkdir(parents=True, exist_ok=True)
        options = [*_options(name), '-c', source, '-o', str(objects[source])]
        if not _runs([*compiler, *build_backend.FLAGS, *options], tree):
            return False
    output = ['-lm', '-o', str(library_file(tree, name))]
    return _runs([*compiler, *build_backend.FLAGS, *map(str, objects.values()), *output], tree)


def build_traced(tree: Path, name: str) -> None:
    """One that says which of its places are run: coverage.c, traced_tests.py."""
    sources = [
        *build_backend.LIBRARIES[LIBRARIES[name]].files('*.c'),
        'bench/mutants/coverage.c',
    ]
    options = ['-std=gnu11', '-fPIC', '-shared', *_options(name), *TRACED, f'-DLIBRARY="{name}"']
    output = ['-lm', '-o', str(library_file(tree, name))]
    if not _runs([*build_backend.compiler(), *options, *sources, *output], tree):
        raise SystemExit(f'the library {name} does not compile with {" ".join(TRACED)}')


def built_files(tree: Path, name: str) -> list[Path]:
    """What `build` writes."""
    sources = build_backend.LIBRARIES[LIBRARIES[name]].files('*.c')
    return [library_file(tree, name), *(_object(tree, name, source) for source in sources)]


def _options(name: str) -> list[str]:
    library = build_backend.LIBRARIES[LIBRARIES[name]]
    return [*library.flags, *(f'-I{folder}' for folder in library.folders)]


def _object(tree: Path, name: str, source: str) -> Path:
    return tree / 'build' / name / f'{source.replace("/", "_")}.o'


def _runs(command: list[str], tree: Path) -> bool:
    return subprocess.run(command, cwd=tree, check=False, capture_output=True).returncode == 0
