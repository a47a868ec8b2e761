"""Imports point one way, and the core knows neither ROS nor clocks nor files."""

import ast
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
ROOMS = {'manipulator', 'hexapod_control', 'arm_control', 'bridge', 'hexarm'}
TOP = ('nodes/', '_node.py', 'executables.py', '__main__.py')
ROS = {'rclpy', 'geometry_msgs', 'sensor_msgs', 'std_msgs', 'std_srvs', 'diagnostic_msgs'}
OUTSIDE_CORE = ROS | {'time', 'logging', 'socket', 'subprocess', 'threading'}
CLOCKED = {
    'link_thread.py',
    'board_thread.py',
    'fake_line.py',
    'serial_port.py',
    'stop_memory.py',
    'stop_socket.py',
}


def imports(path):
    found = set()
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Import):
            found |= {alias.name.split('.')[0] for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f'{path}: relative import'
            found.add(node.module.split('.')[0])
    return found


def core_files(room):
    for path in sorted((ROOT / room).rglob('*.py')):
        if not any(part in path.as_posix() for part in TOP):
            yield path


@pytest.mark.parametrize('room', sorted(ROOMS - {'hexarm'}))
def test_imports_point_towards_manipulator(room):
    for path in core_files(room):
        beyond = imports(path) & ROOMS - {room, 'manipulator'}
        assert not beyond, f'{path.relative_to(ROOT)} imports {beyond}'


@pytest.mark.parametrize('room', sorted(ROOMS - {'hexarm'}))
def test_core_knows_no_ros_clock_or_logger(room):
    for path in core_files(room):
        if path.name in CLOCKED:
            continue
        beyond = imports(path) & OUTSIDE_CORE
        assert not beyond, f'{path.relative_to(ROOT)} imports {beyond}'


@pytest.mark.parametrize('room', sorted(ROOMS - {'hexarm'}))
def test_core_opens_no_files(room):
    for path in core_files(room):
        calls = [n for n in ast.walk(ast.parse(path.read_text())) if isinstance(n, ast.Call)]
        opened = [n for n in calls if isinstance(n.func, ast.Name) and n.func.id == 'open']
        assert not opened or path.name in CLOCKED, f'{path.relative_to(ROOT)} opens a file'


def test_tests_know_nothing_of_the_bench_but_those_of_the_bench_itself():
    for path in sorted((ROOT / 'test').rglob('*.py')):
        name = path.relative_to(ROOT).as_posix()
        if not name.startswith('test/bench/'):
            assert 'bench' not in imports(path), name
