import queue
import socket

import pytest

from bridge.stop_socket import StopSocket, domain_here, send_stop, stop_address

BRIDGE = '/test_stop_socket/serial_bridge'


@pytest.fixture
def listening():
    """Starts what listens at an address; a queue of what it heard."""
    started = []

    def start(address):
        heard = queue.Queue()
        listener = StopSocket(address, lambda: heard.put('STOP'), heard.put)
        started.append(listener)
        listener.start()
        return heard

    yield start
    for listener in started:
        listener.close()


def await_listener(address):
    while not send_stop(address):
        pass


def test_every_stop_is_heard_and_nothing_else(listening):
    address = stop_address(BRIDGE, 7)
    heard = listening(address)
    await_listener(address)
    with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as stranger:
        for word in (b'', b'GO', b'STOPS' * 1000):
            stranger.sendto(word, address)
    assert send_stop(address)
    assert [heard.get(timeout=10.0) for _ in range(3)] == ['STOP'] * 3  # b'STOPS…' begins with it
    assert heard.empty()


def test_where_no_bridge_listens_it_is_known(listening):
    address = stop_address(BRIDGE, 7)
    heard = listening(address)
    await_listener(address)
    heard.get(timeout=10.0)
    assert not send_stop(stop_address(BRIDGE, 8))
    assert not send_stop(stop_address('/another/serial_bridge', 7))
    assert not send_stop(stop_address('/' + 'x' * 200, 7))
    assert heard.empty()


def test_a_bridge_whose_address_is_taken_says_so_and_leaves_it_to_the_other(listening):
    address = stop_address(BRIDGE, 7)
    first = listening(address)
    await_listener(address)
    assert 'not heard but over ROS' in listening(address).get(timeout=10.0)
    assert first.get(timeout=10.0) == 'STOP'


@pytest.mark.parametrize(('words', 'domain'), [('', 0), ('42', 42), ('x', 0), ('-1', 0)])
def test_the_domain_is_that_of_ros(monkeypatch, words, domain):
    monkeypatch.setenv('ROS_DOMAIN_ID', words)
    assert domain_here() == domain
