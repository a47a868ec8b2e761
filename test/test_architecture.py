"""Imports point one way, and the packages below `hexarm` know neither clocks nor files."""

import ast
import functools
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
LAYERS = ({'manipulator'}, {'hexapod_control', 'arm_control', 'bridge'}, {'hexarm'})
"""From below to above. A package imports itself and what is below it."""
PACKAGES = set().union(*LAYERS)
OURS = PACKAGES | {'firmware', 'bench', 'world', 'patient_user', 'test'}
ROS = {'rclpy', 'geometry_msgs', 'sensor_msgs', 'std_msgs', 'std_srvs', 'diagnostic_msgs'}
OUTSIDE_CORE = ROS | {'time', 'logging', 'socket', 'subprocess', 'threading'}
NODES = ('nodes/', '_node.py')
CLOCKED = {
    'link_thread.py',
    'board_thread.py',
    'fake_line.py',
    'stop_socket.py',
}
CORE = sorted(PACKAGES - {'hexarm'})


@functools.cache
def nodes(path):
    """The imports and calls of a file, as they stand in it."""
    kinds = ast.Import | ast.ImportFrom | ast.Call
    return [n for n in ast.walk(ast.parse(path.read_text())) if isinstance(n, kinds)]


@functools.cache
def imports(path):
    found = set()
    for node in nodes(path):
        if isinstance(node, ast.Import):
            found |= {alias.name.split('.')[0] for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f'{path}: relative import'
            found.add(node.module.split('.')[0])
    return found


def files(package):
    return sorted((ROOT / package).rglob('*.py'))


def core_files(package):
    return [p for p in files(package) if not any(part in p.as_posix() for part in NODES)]


@pytest.mark.parametrize('package', sorted(PACKAGES))
def test_a_package_imports_only_itself_and_what_is_below(package):
    level = next(n for n, layer in enumerate(LAYERS) if package in layer)
    allowed = {package}.union(*LAYERS[:level])
    for path in files(package):
        beyond = imports(path) & OURS - allowed
        assert not beyond, f'{path.relative_to(ROOT)} imports {beyond}'


def test_these_packages_are_what_is_installed():
    (listed,) = re.findall(r'^PACKAGES = \[(.*)\]$', (ROOT / 'setup.py').read_text(), re.MULTILINE)
    assert set(re.findall(r"'(\w+)'", listed)) == PACKAGES


@pytest.mark.parametrize('package', CORE)
def test_core_knows_no_ros_clock_or_logger(package):
    for path in core_files(package):
        if path.name in CLOCKED:
            continue
        beyond = imports(path) & OUTSIDE_CORE
        assert not beyond, f'{path.relative_to(ROOT)} imports {beyond}'


@pytest.mark.parametrize('package', CORE)
def test_core_opens_no_files(package):
    for path in core_files(package):
        calls = [n.func for n in nodes(path) if isinstance(n, ast.Call)]
        opened = [f for f in calls if isinstance(f, ast.Name) and f.id == 'open']
        assert not opened or path.name in CLOCKED, f'{path.relative_to(ROOT)} opens a file'


IMPORTS_BENCH = re.compile(r'^ *(import|from) bench\b', re.MULTILINE)


def test_tests_know_nothing_of_the_bench_but_those_of_the_bench_itself():
    for path in sorted((ROOT / 'test').rglob('*.py')):
        name = path.relative_to(ROOT).as_posix()
        if not name.startswith('test/bench/'):
            assert not IMPORTS_BENCH.search(path.read_text()), name


CONTROLLING = (
    *(path for path in (ROOT / 'manipulator' / 'nodes').glob('*.py')),
    *(path for path in (ROOT / 'bridge').rglob('*_node.py')),
    *(ROOT / room / 'load.py' for room in ('hexapod_control', 'arm_control')),
)


def files_imported(path):
    """The project's files that a file imports, anywhere in it."""
    names = set()
    for node in nodes(path):
        if isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            names |= {node.module, *(f'{node.module}.{alias.name}' for alias in node.names)}
    paths = [ROOT.joinpath(*name.split('.')) for name in names]
    found = {p.with_suffix('.py') for p in paths} | {p / '__init__.py' for p in paths}
    return {path for path in found if path.is_file()}


def test_nothing_that_controls_a_machine_can_come_to_import_scipy():
    """Its half second and fifty megabytes are for analysis and calibration."""
    seen, waiting = set(), {*CONTROLLING}
    while waiting:
        path = waiting.pop()
        seen.add(path)
        assert 'scipy' not in imports(path), path.relative_to(ROOT)
        waiting |= files_imported(path) - seen
    assert ROOT / 'manipulator' / 'planning' / 'planner.py' in seen
    assert ROOT / 'arm_control' / 'resolved_rate.py' in seen


def test_scipy_is_imported_where_it_is_used():
    """Every command of `hexarm` imports the modules of all commands."""
    for room in sorted(PACKAGES):
        for path in sorted((ROOT / room).rglob('*.py')):
            top = [node for node in nodes(path) if node.col_offset == 0]
            names = {getattr(node, 'module', None) or '' for node in top}
            names |= {
                alias.name for node in top if isinstance(node, ast.Import) for alias in node.names
            }
            assert not any(name.split('.')[0] == 'scipy' for name in names), path
