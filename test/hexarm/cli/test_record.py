"""`hexarm record`: what it refuses before it listens to anything."""

import pytest

from hexarm.cli.main import main


@pytest.mark.parametrize(
    ('words', 'reason'),
    [
        (['-o', 'run.bag'], 'run.bag: a recording ends in .mcap'),
        (['--for', '0'], '0: needs a number of seconds above 0'),
        (['--for', 'ever'], 'ever: needs a number of seconds above 0'),
        (['bad name'], "'bad name' is not a ROS name"),
    ],
)
def test_arguments_that_make_no_sense(words, reason, capsys):
    with pytest.raises(SystemExit) as ended:
        main(['record', *words])
    assert ended.value.code == 2
    assert reason in capsys.readouterr().err


def test_a_file_that_exists_is_kept(tmp_path, capsys):
    path = tmp_path / 'old.mcap'
    path.write_text('precious')
    assert main(['record', '-o', str(path)]) == 2
    assert f'{path}: exists already, and is not overwritten' in capsys.readouterr().err
    assert path.read_text() == 'precious'


def test_a_folder_that_does_not_exist_is_named(tmp_path, capsys):
    path = tmp_path / 'none' / 'new.mcap'
    assert main(['record', '-o', str(path)]) == 2
    assert f'{path}: No such file or directory' in capsys.readouterr().err
