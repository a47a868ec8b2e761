"""The command without, or with an unknown, subcommand."""

import subprocess
import sys

import pytest

from hexarm.main import COMMANDS, main


def test_no_subcommand_prints_help_with_examples_and_fails(capsys):
    assert main([]) == 2
    said = capsys.readouterr().err
    assert 'hexarm up hexapod' in said
    assert said.count('\n    ') >= len(COMMANDS)


def test_unknown_subcommand_names_the_nearest(capsys):
    with pytest.raises(SystemExit) as ended:
        main(['machnies'])
    assert ended.value.code == 2
    said = capsys.readouterr().err
    assert "'machnies' is not one of" in said
    assert "did you mean 'machines'?" in said


def test_unknown_kind_of_graph_names_the_nearest(capsys):
    with pytest.raises(SystemExit) as ended:
        main(['up', 'hexapds'])
    assert ended.value.code == 2
    assert "did you mean 'hexapod'?" in capsys.readouterr().err


def test_version_is_that_of_the_package(capsys):
    with pytest.raises(SystemExit) as ended:
        main(['--version'])
    assert ended.value.code == 0
    name, number = capsys.readouterr().out.split()
    assert name == 'hexarm'
    assert number[0].isdigit()


def test_command_without_ros_says_what_it_needs(tmp_path):
    (tmp_path / 'rclpy.py').write_text('raise ModuleNotFoundError("gone", name="rclpy")\n')
    script = f'import sys; sys.path.insert(0, {str(tmp_path)!r}); import hexarm.main as m; '
    script += "sys.exit(m.main(['up', 'hexapod']))"
    done = subprocess.run(
        [sys.executable, '-c', script], check=False, capture_output=True, text=True, timeout=30
    )
    assert done.returncode == 1
    assert done.stderr.startswith('hexarm: needs the Python module rclpy: install ROS 2 Jazzy')
    assert len(done.stderr.splitlines()) == 1


@pytest.mark.parametrize('command', ['accuracy', 'workspace'])
def test_picture_of_an_unknown_ending_is_refused_before_anything_is_worked_out(command, capsys):
    with pytest.raises(SystemExit) as refusal:
        main([command, 'robocake', '--picture', 'map.foo'])
    assert refusal.value.code == 2
    assert 'a picture ends in one of .png' in capsys.readouterr().err


@pytest.mark.parametrize(
    ('words', 'said'),
    [
        (('--namespace', 'bad name'), 'is no ROS name'),
        (('--machine', 'ur5'), 'hexarm up arm --machine ur5'),
        (('--machine', 'robocaek'), "did you mean 'robocake'"),
    ],
)
def test_up_refuses_in_words_before_a_node_is_started(words, said, capsys):
    assert main(['up', 'hexapod', *words]) == 1
    assert said in capsys.readouterr().err
