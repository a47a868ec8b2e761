import contextlib
import tempfile
import threading
import time
from pathlib import Path

import pytest

from bridge.stop_memory import StopMemory, stop_file


@pytest.fixture
def path(tmp_path):
    return stop_file('/hexapod/serial_bridge', '/dev/ttyACM0', {'XDG_STATE_HOME': str(tmp_path)})


@contextlib.contextmanager
def running(path, said=None):
    memory = StopMemory(path, (said if said is not None else []).append)
    memory.start()
    yield memory
    memory.close()
    assert not memory.is_alive()


def until(is_so):
    end = time.monotonic() + 10.0
    while not is_so() and time.monotonic() < end:
        time.sleep(0.005)
    assert is_so()


def test_a_stop_is_remembered_until_it_is_cleared(path):
    assert not StopMemory(path).is_kept
    with running(path) as memory:
        memory.keep(lambda: True)
    assert StopMemory(path).is_kept
    with running(path) as memory:
        memory.keep(lambda: False)
    assert not StopMemory(path).is_kept


def test_stops_and_clears_of_one_bridge_are_written_as_they_come(path):
    with running(path) as memory:
        for _ in range(2):
            memory.keep(lambda: True)
            until(path.exists)
            memory.keep(lambda: False)
            until(lambda: not path.exists())


def test_a_disk_that_hangs_keeps_no_process_alive(path):
    assert StopMemory(path).daemon


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
    with running(path) as memory:
        memory.keep(lambda: True)
    assert path.exists()


def test_where_nothing_can_be_written_it_says_so_once_and_tries_again(path, monkeypatch):
    monkeypatch.setattr('bridge.stop_memory.RETRY_AFTER', 0.02)
    path.parent.write_text('a file where the folder should be')
    said = []
    with running(path, said) as memory:
        memory.keep(lambda: True)
        assert memory.is_kept
        until(lambda: said)
        time.sleep(0.1)
        assert len(said) == 1
        assert 'a restart forgets' in said[0]
        path.parent.unlink()
        until(path.exists)


def test_nobody_waits_for_a_slow_disk(path, monkeypatch):
    is_slow = threading.Event()
    monkeypatch.setattr(Path, 'touch', lambda self: is_slow.wait(10.0))
    with running(path) as memory:
        before = time.monotonic()
        memory.keep(lambda: True)
        memory.keep(lambda: False)
        memory.keep(lambda: True)
        assert time.monotonic() - before < 1.0
        is_slow.set()
