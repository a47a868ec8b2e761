"""A process joins the graph from an address that no other had lately."""

import os
import socket
import subprocess
import sys
from pathlib import Path

import pytest

import hexarm
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


JOIN = 'import rclpy; rclpy.init(); rclpy.create_node("x").destroy_node(); rclpy.shutdown()'
PROFILE = 'FASTRTPS_DEFAULT_PROFILES_FILE'


def said_on_joining(profile):
    """What Fast DDS says of a profile; it is silent where it understands all of it."""
    command = [sys.executable, '-c', JOIN]
    environment = os.environ | {PROFILE: str(profile)}
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=True)
    return done.stdout + done.stderr


def test_the_profile_is_understood_and_what_is_wrong_in_one_would_be_said(tmp_path):
    profile = Path(hexarm.__file__).with_name('fastdds.xml')
    assert said_on_joining(profile) == ''
    wrong = tmp_path / 'wrong.xml'
    wrong.write_text(profile.read_text().replace('leaseAnnouncement', 'leaseAnouncement'))
    assert 'leaseAnouncement' in said_on_joining(wrong)


@pytest.mark.parametrize('own', [None, '/somewhere/mine.xml'])
def test_the_profile_is_used_unless_the_user_has_one(own):
    environment = {k: v for k, v in os.environ.items() if k != PROFILE}
    environment |= {} if own is None else {PROFILE: own}
    command = [sys.executable, '-c', f'import hexarm, os; print(os.environ["{PROFILE}"])']
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=True)
    expected = own or str(Path(hexarm.__file__).with_name('fastdds.xml'))
    assert done.stdout.strip() == expected
