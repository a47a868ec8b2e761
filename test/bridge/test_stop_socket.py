import select
import socket

import pytest

from bridge.stop_socket import StopSocket, domain_here, send_stop, stop_address

BRIDGE = '/test_stop_socket/serial_bridge'
ADDRESS = stop_address(BRIDGE, 7)


@pytest.fixture
def listening():
    """Opens what receives at an address, and the list of what it received."""
    opened = []

    def start(address):
        received = []
        opened.append(StopSocket(address, lambda: received.append('STOP')))
        return opened[-1], received

    yield start
    for stops in opened:
        stops.close()


def receive_all(stops):
    while select.select([stops], [], [], 0)[0]:
        stops.receive()


def test_every_stop_is_received_and_nothing_else(listening):
    stops, received = listening(ADDRESS)
    assert send_stop(ADDRESS)
    with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as stranger:
        for word in (b'', b'GO', b'STOPS' * 1000):
            stranger.sendto(word, ADDRESS)
    assert send_stop(ADDRESS)
    receive_all(stops)
    assert received == ['STOP'] * 3  # b'STOPS…' begins with it


def test_nothing_to_receive_is_no_error(listening):
    stops, received = listening(ADDRESS)
    stops.receive()
    assert received == []


def test_where_no_bridge_listens_it_is_known(listening):
    stops, received = listening(ADDRESS)
    assert not send_stop(stop_address(BRIDGE, 8))
    assert not send_stop(stop_address('/another/serial_bridge', 7))
    assert not send_stop(stop_address('/' + 'x' * 200, 7))
    receive_all(stops)
    assert received == []


def test_a_bridge_whose_address_is_taken_reports_it_and_leaves_it_to_the_other(listening):
    first, received = listening(ADDRESS)
    second, _ = listening(ADDRESS)
    assert (first.problem, 'over ROS only' in second.problem) == ('', True)
    assert send_stop(ADDRESS)
    receive_all(first)
    assert received == ['STOP']


@pytest.mark.parametrize(('words', 'domain'), [('', 0), ('42', 42), ('x', 0), ('-1', 0)])
def test_the_domain_is_that_of_ros(monkeypatch, words, domain):
    monkeypatch.setenv('ROS_DOMAIN_ID', words)
    assert domain_here() == domain
