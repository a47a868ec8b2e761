"""`hexarm mjcf`: a file that MuJoCo reads, or why there is none."""

import subprocess
import sys
from pathlib import Path

import mujoco
import pytest

from hexarm import machines
from hexarm.cli.main import main


@pytest.mark.parametrize(
    ('machine', 'freedoms', 'drives'),
    [
        ('robocake', 24, 6),
        ('stewart_6_3', 24, 6),
        ('stewart_6_6', 24, 6),
        ('linear_rails', 24, 6),
        ('stack_6_6', 72, 18),
        ('arm_6r', 6, 6),
        ('ur5', 6, 6),
    ],
)
def test_file_is_read_by_mujoco(tmp_path, capsys, machine, freedoms, drives):
    path = tmp_path / 'machine.xml'
    assert main(['mjcf', machine, '--output', str(path)]) == 0
    assert f'{freedoms} freedoms' in capsys.readouterr().out
    model = mujoco.MjModel.from_xml_path(str(path))
    assert (model.nv, model.nu) == (freedoms, drives)


def test_without_output_it_is_printed(capsys):
    assert main(['mjcf', 'robocake']) == 0
    printed = capsys.readouterr().out
    assert mujoco.MjModel.from_xml_string(printed).body('platform').mass[0] == pytest.approx(0.1)


def test_a_machine_that_does_not_assemble_names_the_leg(tmp_path, capsys):
    text = Path(machines.find('robocake')).read_text()
    path = tmp_path / 'short.yaml'
    lengths = 'rod_length_mm: [58.0, 58.0, 58.0, 20.0, 58.0, 58.0]'
    path.write_text(text.replace('rod_length_mm: 58.0', lengths))
    assert main(['mjcf', str(path)]) == 2
    assert 'does not close at home: leg 4: rod too short' in capsys.readouterr().err


@pytest.mark.parametrize(
    ('words', 'reason'),
    [
        (['puma560'], 'dynamics: missing'),
        (['robocake', '--output', '/does/not/exist.xml'], 'cannot write'),
        (['nonsense'], 'no machine is called'),
    ],
)
def test_refusals(capsys, words, reason):
    assert main(['mjcf', *words]) == 2
    assert reason in capsys.readouterr().err


def test_without_mujoco_it_names_what_to_install():
    program = (
        "import sys; sys.modules['mujoco'] = None; from hexarm.cli.main import main; "
        "sys.exit(main(['mjcf', 'robocake']))"
    )
    done = subprocess.run(
        [sys.executable, '-c', program], capture_output=True, text=True, check=False, timeout=60
    )
    assert done.returncode == 1
    assert 'pip install mujoco' in done.stderr
