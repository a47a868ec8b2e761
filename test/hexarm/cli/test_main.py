"""The command without, or with an unknown, subcommand."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from hexarm.cli.commands import COMMANDS
from hexarm.cli.main import main
from hexarm.machines import find

ROOT = Path(__file__).resolve().parents[3]


def test_no_subcommand_prints_help_with_examples_and_fails(capsys):
    assert main([]) == 2
    said = capsys.readouterr().err
    assert 'hexarm up hexapod' in said
    assert said.count('\n    ') >= len(COMMANDS)


@pytest.mark.parametrize(('typed', 'meant'), [('machnies', 'machines'), ('IK', 'ik')])
def test_unknown_subcommand_names_the_nearest(typed, meant, capsys):
    with pytest.raises(SystemExit) as ended:
        main([typed])
    assert ended.value.code == 2
    assert capsys.readouterr().err.endswith(f"'{typed}' is unknown, did you mean '{meant}'?\n")


def test_unknown_subcommand_that_is_near_to_none_lists_all(capsys):
    with pytest.raises(SystemExit):
        main(['frobnicate'])
    said = capsys.readouterr().err
    assert "'frobnicate' is not one of" in said
    assert all(command.name in said for command in COMMANDS)


@pytest.mark.parametrize(
    ('typed', 'reason'),
    [
        (['pose', '--untis', 'mm'], "'--untis' is unknown here, did you mean '--units'?"),
        (['pose', '--untis=mm'], "'--untis=mm' is unknown here, did you mean '--units'?"),
        (['machines', 'ur5'], "'ur5' is unknown here"),
    ],
)
def test_unknown_option_is_reported_by_its_subcommand_with_the_nearest(typed, reason, capsys):
    with pytest.raises(SystemExit) as ended:
        main(typed)
    assert ended.value.code == 2
    said = capsys.readouterr().err
    assert said.startswith(f'usage: hexarm {typed[0]} ')
    assert said.endswith(f'hexarm {typed[0]}: error: {reason}\n')


def test_the_list_of_machines_ends_with_their_folder(capsys):
    assert main(['machines']) == 0
    assert capsys.readouterr().out.endswith(f'\nin {find("robocake").parent}\n')


def test_an_unknown_machine_lists_the_known_as_words(capsys):
    assert main(['ik', 'cake', '--xyz', '0', '0', '0']) == 2
    assert '(shipped: ar4_mk3, arm_6r, ' in capsys.readouterr().err


def test_a_machine_is_named_once(capsys):
    assert main(['up', 'ur5', '--machine', 'arm_6r']) == 2
    assert "both 'ur5' and --machine arm_6r: name one machine" in capsys.readouterr().err


def test_version_is_that_of_the_package(capsys):
    with pytest.raises(SystemExit) as ended:
        main(['--version'])
    assert ended.value.code == 0
    name, number = capsys.readouterr().out.split()
    assert name == 'hexarm'
    assert number[0].isdigit()


def test_command_without_ros_reports_what_it_needs(tmp_path):
    (tmp_path / 'rclpy.py').write_text('raise ModuleNotFoundError("gone", name="rclpy")\n')
    script = f'import sys; sys.path.insert(0, {str(tmp_path)!r}); import hexarm.cli.main as m; '
    script += "sys.exit(m.main(['up', 'hexapod']))"
    done = subprocess.run(
        [sys.executable, '-c', script], check=False, capture_output=True, text=True, timeout=120
    )
    assert done.returncode == 1
    assert done.stderr.startswith('hexarm: needs the Python module rclpy: install ROS 2 Jazzy')
    assert len(done.stderr.splitlines()) == 1


@pytest.mark.parametrize('words', [('hexapod', '--port', '/dev/nothing'), ('ur5', '--port', '/x')])
def test_a_port_that_does_not_exist_is_named_once_and_before_anything_starts(words, capsys):
    assert main(['up', *words]) == 2
    said = capsys.readouterr().err
    assert f'port {words[-1]} does not exist' in said
    assert said.count('\n') == 1


@pytest.mark.parametrize('command', ['accuracy', 'workspace'])
def test_picture_of_an_unknown_ending_is_refused_before_anything_is_worked_out(command, capsys):
    with pytest.raises(SystemExit) as refusal:
        main([command, 'robocake', '--picture', 'map.foo'])
    assert refusal.value.code == 2
    assert 'a picture ends in one of .png' in capsys.readouterr().err


@pytest.mark.parametrize(
    ('words', 'said'),
    [
        (('--namespace', 'bad name'), 'is not a ROS name'),
        (('--machine', 'ur5'), 'hexarm up ur5'),
        (('--machine', 'robocaek'), "did you mean 'robocake'"),
    ],
)
def test_up_refuses_in_words_before_a_node_is_started(words, said, capsys):
    assert main(['up', 'hexapod', *words]) == 2
    assert said in capsys.readouterr().err


@pytest.mark.parametrize('command', ['enable', 'disable', 'clear', 'stop', 'monitor'])
def test_what_is_no_namespace_is_refused_before_ros_is_started(command, capsys):
    with pytest.raises(SystemExit) as ended:
        main([command, 'bad name'])
    assert ended.value.code == 2
    assert "'bad name' is not a ROS name" in capsys.readouterr().err


def test_ctrl_c_while_modules_are_imported_is_silent():
    # A shell's background job ignores SIGINT, and hands that down.
    script = (
        'import sys, signal, builtins; real = builtins.__import__\n'
        'signal.signal(signal.SIGINT, signal.default_int_handler)\n'
        'def late(name, *rest):\n'
        '    if name == "numpy": signal.raise_signal(signal.SIGINT)\n'
        '    return real(name, *rest)\n'
        'from hexarm.cli.main import main; builtins.__import__ = late\n'
        'sys.exit(main(["up", "hexapod"]))'
    )
    done = subprocess.run(
        [sys.executable, '-c', script], check=False, capture_output=True, text=True, timeout=60
    )
    assert (done.returncode, done.stdout, done.stderr) == (130, '', '')


def test_the_command_itself_is_light_so_that_ctrl_c_is_caught_early():
    script = 'import sys, hexarm.cli.main; sys.exit("numpy" in sys.modules)'
    assert subprocess.run([sys.executable, '-c', script], check=False, timeout=60).returncode == 0


@pytest.mark.parametrize(
    'words', [('machines',), ('--help',), ('check', 'robocake'), ('check', '!')]
)
def test_output_that_nobody_reads_ends_it_quietly(words):
    reader, writer = os.pipe()
    os.close(reader)
    with os.fdopen(writer, 'wb') as nobody:
        done = subprocess.run(
            [sys.executable, '-m', 'hexarm', *words], cwd=ROOT, check=False, timeout=60,
            stdout=nobody, stderr=subprocess.PIPE,
        )  # fmt: skip
    assert done.stderr == b''
    # argparse itself passes over help that cannot be written.
    assert done.returncode == 141 or words == ('--help',)


def test_wrong_arguments_are_not_repeated_whole(capsys):
    with pytest.raises(SystemExit) as ended:
        main(['fk', 'robocake', 'x' * 5000])
    assert ended.value.code == 2
    assert len(capsys.readouterr().err) < 800


@pytest.mark.parametrize('command', ['replay', 'delete'])
def test_a_namespace_alone_is_not_taken_for_a_pose(command, capsys):
    with pytest.raises(SystemExit) as ended:
        main([command, 'hexapod'])
    assert ended.value.code == 2
    assert 'required: NAME' in capsys.readouterr().err
