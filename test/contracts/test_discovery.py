"""A process joins the graph from an address that no other had lately."""

import os
import socket

import pytest

from manipulator.nodes import discovery


@pytest.fixture(autouse=True)
def runtime(tmp_path, monkeypatch):
    monkeypatch.setenv('XDG_RUNTIME_DIR', str(tmp_path))
    monkeypatch.setenv('ROS_DOMAIN_ID', '101')
    return tmp_path


def free_addresses():
    """The addresses whose port can be taken, as Fast DDS looks for one."""
    free = set()
    for address in range(discovery.ADDRESSES):
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as one:
            try:
                one.bind(('', 7400 + 250 * 101 + 10 + 2 * address))
            except OSError:
                continue
            free.add(address)
    return free


def lowest():
    with discovery.fresh_address():
        return min(free_addresses())


def test_each_process_gets_the_next_address_and_after_the_last_the_first_again():
    turns = [lowest() for _ in range(discovery.ADDRESSES + 1)]
    assert turns == [*range(1, discovery.ADDRESSES), 0, 1]


def test_nothing_is_held_once_the_node_is_there():
    lowest()
    assert free_addresses() == set(range(discovery.ADDRESSES))


def test_port_of_another_process_is_left_to_it():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as other:
        other.bind(('', 7400 + 250 * 101 + 10))
        assert lowest() == 1


@pytest.mark.parametrize('content', [b'', b'\xff', b'what is this?'])
def test_any_content_of_the_file_will_do(runtime, content):
    (runtime / f'hexarm-turn-{os.getuid()}').write_bytes(content)
    assert lowest() in range(discovery.ADDRESSES)


def test_link_in_the_place_of_the_file_is_not_followed(runtime):
    victim = runtime / 'victim'
    victim.write_text('kept')
    (runtime / f'hexarm-turn-{os.getuid()}').symlink_to(victim)
    assert lowest() in range(discovery.ADDRESSES)
    assert victim.read_text() == 'kept'


@pytest.mark.parametrize('domain', ['', 'seven', '-3', '100000'])
def test_what_is_no_domain_is_left_to_rclpy_to_refuse(monkeypatch, domain):
    monkeypatch.setenv('ROS_DOMAIN_ID', domain)
    with discovery.fresh_address():
        assert free_addresses() == set(range(discovery.ADDRESSES))
