"""`hexarm up` and `hexarm demo` as processes: how they begin and how they end."""

import os
import signal
import time
import urllib.request
from pathlib import Path

import pytest

pytestmark = pytest.mark.graph

ROBOCAKE = Path(__file__).resolve().parents[2] / 'config' / 'robocake.yaml'


def wait_until_none_is_left(processes_left):
    deadline = time.monotonic() + 60.0
    while processes_left() and time.monotonic() < deadline:
        time.sleep(0.05)
    assert processes_left() == {}


def node_of(words, processes_left):
    found = [pid for pid, line in processes_left().items() if f' {words} ' in line]
    assert len(found) == 1, processes_left()
    return found[0]


def page_of(address):
    """What its server answers, once it is there."""
    deadline = time.monotonic() + 60.0
    while True:
        try:
            with urllib.request.urlopen(address, timeout=60) as page:
                return page.read().decode()
        except OSError:
            if time.monotonic() > deadline:
                raise
            time.sleep(0.1)


def test_up_enables_serves_its_panel_and_parks_on_ctrl_c(hexarm_up, ends_parked, processes_left):
    process, text = hexarm_up('hexapod', '--panel', until='The panel is on')
    assert 'is up on fake and enabled' in text
    assert len(processes_left()) == 3  # up with its four nodes, the board, the panel
    address = text.split('The panel is on')[1].split()[0]
    assert '<title>' in page_of(address)
    rest = ends_parked(process)
    machine = f'machine robocake: {ROBOCAKE} (rotary hexapod; RoboCake, crank'
    assert (text + rest).count(machine) == 3
    wait_until_none_is_left(processes_left)


@pytest.mark.parametrize(
    ('node', 'words'), [('fake_hardware', ()), ('trajectory', ('--separate',))]
)
def test_up_reports_which_process_died_stops_the_rest_and_fails(
    hexarm_up, processes_left, node, words
):
    process, _ = hexarm_up('robocake', *words)
    os.kill(node_of(node, processes_left), signal.SIGKILL)
    rest = process.stdout.read()
    assert process.wait(60) == 1
    assert f'{node} ended with status -9; stopping the others' in rest
    wait_until_none_is_left(processes_left)


def test_nodes_end_when_up_itself_is_killed(hexarm_up, processes_left):
    process, _ = hexarm_up('hexapod')
    process.kill()
    process.wait(60)
    wait_until_none_is_left(processes_left)


def test_up_with_an_unknown_machine_names_the_nearest(hexarm, processes_left):
    process = hexarm('up', 'hexapod', '--machine', 'robocaek')
    output = process.stdout.read()
    assert process.wait(60) != 0
    assert "did you mean 'robocake'" in output
    wait_until_none_is_left(processes_left)


def test_demo_ends_cleanly_on_ctrl_c(hexarm, processes_left, tmp_path):
    def one_that_drives():
        process = hexarm('demo', '--picture', str(tmp_path / 'demo.png'))
        return process if any('up by 8 mm' in line for line in process.stdout) else None

    process = next(filter(None, (one_that_drives() for _ in range(5))))
    process.send_signal(signal.SIGINT)
    process.stdout.read()
    assert process.wait(60) == 130
    wait_until_none_is_left(processes_left)


def test_demo_goes_through_with_a_table_and_a_picture(hexarm, processes_left, tmp_path):
    """Again where this computer stood still; how exact it drove then, is no verdict."""
    picture = tmp_path / 'demo.png'

    def output_of_one():
        process = hexarm('demo', '--picture', str(picture))
        output = process.stdout.read()
        return output if process.wait(60) == 0 else ''

    output = next(filter(None, (output_of_one() for _ in range(5))))
    for row in ('contour error', 'goals refused', 'six-axis arm', 'The picture is in'):
        assert row in output
    assert picture.stat().st_size > 50_000
    wait_until_none_is_left(processes_left)
