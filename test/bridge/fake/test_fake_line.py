import os

import pytest

from bridge.fake.fake_line import FakeLine
from manipulator.errors import LinkError


def test_the_link_is_made_and_removed(tmp_path):
    path = tmp_path / 'board'
    line = FakeLine(path)
    assert str(path.readlink()).startswith('/dev/pts/')
    line.close()
    assert not path.is_symlink()


def test_a_dead_link_of_ours_is_replaced(tmp_path):
    path = tmp_path / 'board'
    path.symlink_to('/dev/pts/987654')
    line = FakeLine(path)
    assert path.exists()
    line.close()


@pytest.mark.parametrize('kind', ['file', 'folder', 'foreign link', 'dead foreign link'])
def test_whatever_else_stands_there_is_left_alone(tmp_path, kind):
    path = tmp_path / 'board'
    (tmp_path / 'treasure').write_text('gold')
    {
        'file': lambda: path.write_text('gold'),
        'folder': path.mkdir,
        'foreign link': lambda: path.symlink_to(tmp_path / 'treasure'),
        'dead foreign link': lambda: path.symlink_to(tmp_path / 'nowhere'),
    }[kind]()
    before = os.lstat(path)
    with pytest.raises(LinkError, match='not overwritten'):
        FakeLine(path)
    assert os.lstat(path) == before


def test_two_boards_cannot_have_one_path(tmp_path):
    first = FakeLine(tmp_path / 'board')
    with pytest.raises(LinkError, match='not overwritten'):
        FakeLine(tmp_path / 'board')
    first.close()


def test_a_folder_that_does_not_exist_is_reported(tmp_path):
    with pytest.raises(LinkError, match='cannot be made: No such file or directory'):
        FakeLine(tmp_path / 'no' / 'board')


def test_no_descriptor_is_left_open_by_a_refusal(tmp_path):
    (tmp_path / 'board').write_text('gold')
    before = len(os.listdir('/proc/self/fd'))
    for _ in range(5):
        with pytest.raises(LinkError):
            FakeLine(tmp_path / 'board')
    assert len(os.listdir('/proc/self/fd')) == before
