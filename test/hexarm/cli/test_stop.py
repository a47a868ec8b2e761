"""What `hexarm stop` does first: a STOP waits for nothing that it does not need."""

import argparse
import subprocess
import sys

import pytest

from bridge.stop_socket import StopSocket, stop_address
from hexarm.cli.running import stop
from hexarm.cli.running.stop import press


class Button:
    """At each wait of a hundredth of a second the next of `moments`: subscribers, state."""

    def __init__(self, *moments):
        self.moments = list(moments)
        self.now = 100.0
        self.log = []
        self._step()

    def _step(self):
        if self.moments:
            self.subscribers, self.state = self.moments.pop(0)

    def publish(self):
        self.log.append((self.subscribers, self.state))

    def wait(self):
        self.now += 0.01
        self._step()


def pressed(button):
    return press(button, lambda: button.now)


NONE, ENABLED, STOPPED = None, ('enabled', ''), ('stopped', 'until ~/clear_fault is called')


def test_a_stop_goes_out_with_the_first_subscriber_and_before_anything_was_received():
    button = Button((0, NONE), (1, NONE), (1, ENABLED), (1, STOPPED))
    assert pressed(button)
    assert button.log == [(1, NONE)]


def test_it_is_sent_to_every_subscriber_that_comes_since_the_first_may_be_a_recorder():
    button = Button((0, NONE), (1, NONE), (1, NONE), (2, NONE), (2, STOPPED))
    assert pressed(button)
    assert button.log == [(1, NONE), (2, NONE)]


def test_a_machine_that_is_stopped_already_is_stopped_once_more():
    button = Button((0, STOPPED), (0, STOPPED), (1, STOPPED))
    assert pressed(button)
    assert button.log == [(1, STOPPED)]


def test_it_is_repeated_until_the_machine_stands():
    button = Button(*[(1, ENABLED)] * 40, (1, STOPPED))
    assert pressed(button)
    assert 3 <= len(button.log) <= 5


@pytest.mark.parametrize('state', [ENABLED, ('disconnected', 'no port'), NONE])
def test_it_is_not_reported_to_stand_where_it_never_reports_that(state):
    button = Button((1, state))
    assert not pressed(button)
    assert len(button.log) > 20


def test_where_nobody_listens_it_gives_up_in_the_end():
    button = Button((0, NONE))
    assert not pressed(button)
    assert button.log == []


def test_a_bridge_of_this_computer_is_reported_before_the_graph_is_joined(monkeypatch):
    monkeypatch.setenv('ROS_DOMAIN_ID', '7')
    received = []
    stops = StopSocket(stop_address('/test_stop/serial_bridge', 7), lambda: received.append(1))

    def join(namespace):
        stops.receive()
        assert received == [1]
        raise KeyboardInterrupt

    monkeypatch.setattr(stop, 'StopNode', join)
    with pytest.raises(KeyboardInterrupt):
        stop.run(argparse.Namespace(namespace='test_stop'))
    stops.close()


def test_no_other_subcommand_is_loaded_nor_ros_before_the_first_stop_is_out():
    heavy = ['numpy', 'yaml', 'rclpy', 'hexarm.cli.running.up', 'hexarm.client']
    code = (
        'import sys\nfrom hexarm.cli import main\nfrom hexarm.cli.running import stop\n'
        f'loaded = lambda address: sys.exit(str([m for m in {heavy} if m in sys.modules]))\n'
        'stop.send_stop = loaded\n'
        "main.main(['stop'])"
    )
    done = subprocess.run(
        [sys.executable, '-c', code], capture_output=True, text=True, timeout=60, check=False
    )
    assert done.stderr.strip() == '[]'
