"""`hexarm up` and `hexarm demo` as processes: how they begin and how they end."""

import os
import signal
import time
import urllib.request
from pathlib import Path

import pytest

pytestmark = pytest.mark.graph

ROBOCAKE = Path(__file__).resolve().parents[2] / 'config' / 'robocake.yaml'


def read_until(process, words):
    lines = []
    for line in process.stdout:
        lines.append(line)
        if words in line:
            return ''.join(lines)
    raise AssertionError(f'{words!r} never came:\n' + ''.join(lines))


def wait_until_none_is_left(processes_left):
    deadline = time.monotonic() + 60.0
    while processes_left() and time.monotonic() < deadline:
        time.sleep(0.05)
    assert processes_left() == {}


def node_of(words, processes_left):
    found = [pid for pid, line in processes_left().items() if f' {words} ' in line]
    assert len(found) == 1, processes_left()
    return found[0]


def test_up_enables_runs_and_parks_on_ctrl_c(hexarm, processes_left):
    process = hexarm('up', 'hexapod')
    said = read_until(process, 'is up on fake and enabled')
    assert said.count(f'machine robocake: {ROBOCAKE} (rotary hexapod; RoboCake, crank') == 2
    assert len(processes_left()) == 2  # up, the board
    process.send_signal(signal.SIGINT)
    rest = process.stdout.read()
    assert process.wait(60) == 0
    assert 'parking' in rest
    assert 'not parked' not in rest
    wait_until_none_is_left(processes_left)


def test_up_with_a_panel_tells_where_its_page_is(hexarm, processes_left):
    process = hexarm('up', 'hexapod', '--panel')
    said = read_until(process, 'The panel is on')
    address = said.split('The panel is on')[1].split()[0]
    with urllib.request.urlopen(address, timeout=20) as page:
        assert '<title>' in page.read().decode()
    process.send_signal(signal.SIGINT)
    rest = process.stdout.read()
    assert process.wait(60) == 0
    assert 'Traceback' not in rest
    wait_until_none_is_left(processes_left)


@pytest.mark.parametrize(
    ('node', 'words'), [('fake_hardware', ()), ('trajectory', ('--separate',))]
)
def test_up_says_which_process_died_stops_the_rest_and_fails(hexarm, processes_left, node, words):
    process = hexarm('up', 'robocake', *words)
    read_until(process, 'is up on fake and enabled')
    os.kill(node_of(node, processes_left), signal.SIGKILL)
    rest = process.stdout.read()
    assert process.wait(60) == 1
    assert f'{node} ended with status -9; stopping the others' in rest
    wait_until_none_is_left(processes_left)


def test_nodes_end_when_up_itself_is_killed(hexarm, processes_left):
    process = hexarm('up', 'hexapod')
    read_until(process, 'is up on fake and enabled')
    process.kill()
    process.wait(60)
    wait_until_none_is_left(processes_left)


def test_up_without_a_board_says_so_and_fails(hexarm, processes_left):
    process = hexarm('up', 'hexapod', '--port', '/dev/does-not-exist')
    output = process.stdout.read()
    assert process.wait(60) == 1
    assert '/dev/does-not-exist does not exist' in output
    wait_until_none_is_left(processes_left)


def test_up_with_an_unknown_machine_names_the_nearest(hexarm, processes_left):
    process = hexarm('up', 'hexapod', '--machine', 'robocaek')
    output = process.stdout.read()
    assert process.wait(60) != 0
    assert "did you mean 'robocake'" in output
    wait_until_none_is_left(processes_left)


def test_demo_ends_cleanly_on_ctrl_c(hexarm, processes_left, tmp_path):
    process = hexarm('demo', '--picture', str(tmp_path / 'demo.png'))
    read_until(process, 'a circle')
    process.send_signal(signal.SIGINT)
    process.stdout.read()
    assert process.wait(60) == 130
    wait_until_none_is_left(processes_left)


def test_demo_goes_through_and_its_picture_and_errors_are_good(hexarm, processes_left, tmp_path):
    """Again where this computer stood still: the machine then held, or cut a corner."""
    picture = tmp_path / 'demo.png'

    def is_good():
        process = hexarm('demo', '--picture', str(picture))
        output = process.stdout.read()
        print(output)
        if process.wait(60) != 0:
            return False
        (row,) = [line for line in output.splitlines() if 'contour error' in line]
        (refused,) = [line for line in output.splitlines() if 'goals refused' in line]
        return float(row.split('max')[1].split()[0]) <= 0.4 and refused.split()[-1] == '1'

    assert any(is_good() for _ in range(5))
    assert picture.stat().st_size > 50_000
    wait_until_none_is_left(processes_left)
