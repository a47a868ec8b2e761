import tempfile
from pathlib import Path

import pytest

from bridge.stop_memory import StopMemory, stop_file


@pytest.fixture
def path(tmp_path):
    return stop_file('/hexapod/serial_bridge', '/dev/ttyACM0', {'XDG_STATE_HOME': str(tmp_path)})


def test_a_stop_is_remembered_until_it_is_cleared(path):
    assert not StopMemory(path).is_kept
    memory = StopMemory(path)
    assert memory.keep(True) == ''
    assert StopMemory(path).is_kept
    assert memory.keep(False) == ''
    assert not StopMemory(path).is_kept


def test_two_machines_do_not_share_it(tmp_path):
    home = {'XDG_STATE_HOME': str(tmp_path)}
    pairs = [('/hexapod/serial_bridge', '/dev/a'), ('/hexapod/serial_bridge', '/dev/b')]
    pairs += [('/arm/serial_bridge', '/dev/a')]
    paths = {stop_file(*pair, home) for pair in pairs}
    assert len(paths) == 3
    assert {path.parent for path in paths} == {tmp_path / 'hexarm'}


def test_of_a_fake_board_it_stands_beside_its_port(tmp_path):
    assert stop_file('/a/serial_bridge', f'{tmp_path}/board') == tmp_path / 'board.stop'


def test_a_user_without_a_home_has_it_too():
    path = stop_file('/a/serial_bridge', '/dev/a', {})
    assert path == Path(tempfile.gettempdir(), '.local/state/hexarm/stop_a_serial_bridge_dev_a')


def test_a_long_port_name_makes_no_file_that_cannot_be(tmp_path):
    path = stop_file('/a', '/dev/' + 'x' * 5000, {'XDG_STATE_HOME': str(tmp_path)})
    assert StopMemory(path).keep(True) == ''


def test_where_nothing_can_be_written_it_says_so_once_and_goes_on(tmp_path):
    (tmp_path / 'hexarm').write_text('a file where the folder should be')
    memory = StopMemory(tmp_path / 'hexarm' / 'stop')
    assert 'a restart forgets' in memory.keep(True)
    assert memory.keep(True) == ''
    assert memory.is_kept


def test_a_write_that_failed_is_tried_again(path, monkeypatch):
    now = [100.0]
    monkeypatch.setattr('bridge.stop_memory.time.monotonic', lambda: now[0])
    path.parent.write_text('in the way of the folder')
    memory = StopMemory(path)
    assert 'a restart forgets' in memory.keep(True)
    path.parent.unlink()
    assert memory.keep(True) == ''
    assert not path.exists()
    now[0] += 3.0
    assert memory.keep(True) == ''
    assert StopMemory(path).is_kept
