"""Scratch installations of this package, made with the environment's own Python."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
NOT_SOURCE = shutil.ignore_patterns('.*', '__pycache__', '*.egg-info', 'build', 'test')
ROS_PREFIXES = os.environ.get('AMENT_PREFIX_PATH', sys.prefix)


@pytest.fixture(scope='session')
def source(tmp_path_factory):
    """A copy of the source tree, because builds leave files beside it."""
    copy = tmp_path_factory.mktemp('workspace') / 'src' / 'hexarm'
    shutil.copytree(ROOT, copy, ignore=NOT_SOURCE)
    return copy


@pytest.fixture(scope='session')
def run():
    """Runs a command to its end and returns what it printed; its failure is the test's."""

    def start(*command, **options):
        pipes = {'stdout': subprocess.PIPE, 'stderr': subprocess.STDOUT, 'text': True}
        done = subprocess.run(
            [str(w) for w in command], check=False, timeout=600, **(pipes | options)
        )
        assert done.returncode == 0, done.stdout
        return done.stdout

    return start


@pytest.fixture(scope='session')
def colcon_prefix(source, run):
    """Where `colcon build` has put the package."""
    workspace = source.parent.parent
    environment = os.environ | {'AMENT_PREFIX_PATH': ROS_PREFIXES}
    run(sys.executable, '-m', 'colcon', 'build', cwd=workspace, env=environment)
    return workspace / 'install' / 'hexarm'


@pytest.fixture(scope='session')
def colcon_environment(colcon_prefix):
    """The variables that the workspace's setup.bash sets."""
    (packages,) = colcon_prefix.glob('lib/python3*/site-packages')
    known = os.environ.get('PYTHONPATH', '')
    return os.environ | {
        'AMENT_PREFIX_PATH': os.pathsep.join([str(colcon_prefix), ROS_PREFIXES]),
        'PYTHONPATH': os.pathsep.join([str(packages), known]) if known else str(packages),
    }


@pytest.fixture(scope='session')
def executables():
    """The names in setup.py's console_scripts."""
    text = (ROOT / 'setup.py').read_text()
    lines = text.split("'console_scripts': [")[1].split(']')[0].split(',')
    return {line.split("'")[1].split(' = ')[0] for line in lines if "'" in line}


@pytest.fixture(scope='session')
def machines():
    """The names of the machine files in config/."""
    files = (ROOT / 'config').glob('*.yaml')
    return {file.stem for file in files if '\nkind:' in '\n' + file.read_text()}
