"""`pip install .` in an environment of its own, and no installation at all."""

import json
import os
import subprocess
import sys
import sysconfig
import venv
from pathlib import Path

import pytest

TOOLS = {'hexarm', 'hexapod_ik', 'hexapod_pose', 'hexapod_trajectory', 'serial_bridge'}


def install(run, environment, source, folder):
    """A wheel of a source tree or an sdist, made in a folder, into an environment."""
    offline = ('--disable-pip-version-check', '--no-deps', '--no-index')
    pip = (sys.executable, '-m', 'pip')
    run(*pip, 'wheel', *offline, '--no-build-isolation', '-w', folder, source)
    (wheel,) = folder.glob('*.whl')
    run(*pip, '--python', environment, 'install', *offline, wheel)


@pytest.fixture(scope='module')
def scratch(source, run, tmp_path_factory):
    """A virtual environment with hexarm, sdist to wheel; dependencies come from ours."""
    folder = tmp_path_factory.mktemp('pip')
    sdist = 'import build_backend, sys; build_backend.build_sdist(sys.argv[1])'
    run(sys.executable, '-c', sdist, folder, cwd=source)
    (archive,) = folder.glob('*.tar.gz')
    environment = folder / 'environment'
    venv.create(environment, symlinks=True)
    install(run, environment, archive, folder)
    (packages,) = environment.glob('lib/python3*/site-packages')
    (packages / 'dependencies.pth').write_text(sysconfig.get_path('purelib') + '\n')
    return environment


@pytest.fixture
def nowhere(tmp_path):
    """Options of a process that starts far from the source tree, without its paths."""
    kept = {k: v for k, v in os.environ.items() if k != 'PYTHONPATH'}
    return {'cwd': tmp_path, 'env': kept}


def test_every_command_is_in_bin(scratch, executables):
    assert executables >= TOOLS
    assert executables <= {file.name for file in (scratch / 'bin').iterdir()}


def test_a_type_checker_is_told_that_the_packages_are_typed(scratch):
    (packages,) = scratch.glob('lib/python3*/site-packages')
    marked = {file.parent.name for file in packages.glob('*/py.typed')}
    assert marked == {'manipulator', 'hexapod_control', 'arm_control', 'bridge', 'hexarm'}


def test_the_page_of_a_package_index_is_the_readme(scratch, source):
    (metadata,) = scratch.glob('lib/python3*/site-packages/hexarm-*.dist-info/METADATA')
    assert metadata.read_text().endswith((source / 'README.md').read_text())


def test_machine_files_are_found_in_the_environment(scratch, machines, run, nowhere):
    answer = json.loads(run(scratch / 'bin' / 'hexarm', 'machines', '--json', **nowhere))
    assert {entry['name'] for entry in answer['machines']} == machines
    config = scratch / 'share' / 'hexarm' / 'config'
    assert {entry['path'] for entry in answer['machines']} == {
        str(config / f'{name}.yaml') for name in machines
    }
    assert (config / 'machine.schema.json').is_file()


def test_profile_of_discovery_is_installed(scratch, run, nowhere):
    variable = 'FASTRTPS_DEFAULT_PROFILES_FILE'
    nowhere['env'].pop(variable, None)
    code = f'import hexarm, os; print(os.environ["{variable}"])'
    profile = Path(run(scratch / 'bin' / 'python', '-c', code, **nowhere).strip())
    assert profile.is_file()
    assert profile.is_relative_to(scratch)


def test_installed_kinematics_answers(scratch, run, nowhere):
    words = ('ik', 'robocake', '--xyz', '0', '0', '0.04119', '--json')
    joints = json.loads(run(scratch / 'bin' / 'hexarm', *words, **nowhere))['joints']
    assert joints['positions'] == pytest.approx([2.0945] * 6, abs=1e-3)


STRANGER = """
[project]
name = "panel"
version = "1.0"
[project.scripts]
panel = "panel:main"
[tool.setuptools]
packages = ["panel"]
"""


def test_another_project_called_panel_and_this_one_leave_each_other_alone(
    scratch, run, nowhere, tmp_path
):
    """HoloViz Panel's import name and command; a stand-in for it, installed after ours."""
    (tmp_path / 'panel').mkdir()
    (tmp_path / 'panel' / '__init__.py').write_text('def main():\n    print("a stranger")\n')
    (tmp_path / 'pyproject.toml').write_text(STRANGER)
    install(run, scratch, tmp_path, tmp_path)
    assert run(scratch / 'bin' / 'panel', **nowhere) == 'a stranger\n'
    code = 'import panel, hexarm.panel; print(panel.__file__ != hexarm.panel.__file__)'
    assert run(scratch / 'bin' / 'python', '-c', code, **nowhere) == 'True\n'


def test_source_tree_runs_without_installation(source, machines, run):
    answer = json.loads(run(sys.executable, '-m', 'hexarm', 'machines', '--json', cwd=source))
    assert {entry['path'] for entry in answer['machines']} == {
        str(source / 'config' / f'{name}.yaml') for name in machines
    }


def refusal(source, *words, **variables):
    """Status and message of a module of the source tree that does not start."""
    done = subprocess.run(
        [sys.executable, '-m', *words],
        check=False,
        cwd=source,
        env=os.environ | variables,
        text=True,
        capture_output=True,
        timeout=120,
    )
    return done.returncode, done.stderr.strip()


def test_an_unknown_node_is_answered_with_the_known_ones(source):
    status, reason = refusal(source, 'hexarm.nodes', 'ink')
    assert status == 2
    assert reason.startswith('needs one of the names machine, trajectory, ik, pose, serial_bridge')


def test_node_of_the_source_tree_names_the_machines_that_it_ships(source):
    words = ('hexarm.nodes', 'ik', '--ros-args', '-p', 'machine:=robocale')
    status, said = refusal(source, *words)
    assert status == 1
    assert said.startswith("ik: no machine is called 'robocale', did you mean 'robocake'?")
    assert len(said.splitlines()) == 1


def test_missing_ruckig_is_reported_in_one_sentence(source, tmp_path):
    (tmp_path / 'ruckig.py').write_text('raise ModuleNotFoundError("gone", name="ruckig")\n')
    paths = os.pathsep.join([str(tmp_path), os.environ.get('PYTHONPATH', '')])
    assert refusal(source, 'hexarm.nodes', 'trajectory', PYTHONPATH=paths) == (
        1,
        'trajectory: needs the Python module ruckig: python3 -m pip install ruckig',
    )
