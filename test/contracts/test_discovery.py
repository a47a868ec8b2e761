"""How processes find each other: by sockets alone, announced every 0.2 s, or as the user says."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

import hexarm

pytestmark = pytest.mark.processes

JOIN = 'import rclpy; rclpy.init(); rclpy.create_node("x").destroy_node(); rclpy.shutdown()'
PROFILE, RANGE = 'FASTRTPS_DEFAULT_PROFILES_FILE', 'ROS_AUTOMATIC_DISCOVERY_RANGE'
OTHERS = ('RMW_IMPLEMENTATION', 'ROS_STATIC_PEERS', 'SKIP_DEFAULT_XML_FILE')
FOLDER = Path(hexarm.__file__).parent
EVERYWHERE, LOOPBACK = (str(FOLDER / f'{name}.xml') for name in ('fastdds', 'fastdds_loopback'))

MAPPED = """
import hexarm, json, rclpy
rclpy.init()
node = rclpy.create_node("x")
mapped = [line.split()[-1] for line in open("/proc/self/maps")]
print(json.dumps([name for name in mapped if "fastrtps" in name and "/shm/" in name]))
"""


def run(code, **variables):
    """What a new Python prints, with only these of the variables that matter."""
    neutral = {k: v for k, v in os.environ.items() if k not in (PROFILE, RANGE, *OTHERS)}
    command = [sys.executable, '-c', code]
    environment = neutral | variables
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=True)
    return done.stdout + done.stderr


@pytest.mark.parametrize('profile', [EVERYWHERE, LOOPBACK], ids=['everywhere', 'loopback'])
def test_the_profile_is_understood_and_what_is_wrong_in_one_would_be_said(tmp_path, profile):
    assert run(JOIN, **{PROFILE: profile}) == ''
    wrong = tmp_path / 'wrong.xml'
    wrong.write_text(Path(profile).read_text().replace('leaseAnnouncement', 'leaseAnouncement'))
    assert 'leaseAnouncement' in run(JOIN, **{PROFILE: str(wrong)})


def chosen(**variables):
    code = f'import hexarm, os; print(os.environ["{PROFILE}"], os.environ.get("{RANGE}"))'
    return tuple(run(code, **variables).split())


@pytest.mark.parametrize(
    ('variables', 'expected'),
    [
        ({}, (EVERYWHERE, 'None')),
        ({RANGE: 'SUBNET'}, (EVERYWHERE, 'SUBNET')),
        ({RANGE: 'LOCALHOST'}, (LOOPBACK, 'SUBNET')),
        ({RANGE: 'SUBNET', PROFILE: LOOPBACK}, (LOOPBACK, 'SUBNET')),
        ({RANGE: 'LOCALHOST', PROFILE: EVERYWHERE}, (LOOPBACK, 'SUBNET')),
        ({RANGE: 'LOCALHOST', PROFILE: LOOPBACK}, (LOOPBACK, 'SUBNET')),
        ({RANGE: 'LOCALHOST', PROFILE: '/mine.xml'}, ('/mine.xml', 'LOCALHOST')),
        ({PROFILE: '/mine.xml'}, ('/mine.xml', 'None')),
        ({RANGE: 'LOCALHOST', 'ROS_STATIC_PEERS': '10.0.0.2'}, (EVERYWHERE, 'LOCALHOST')),
        ({RANGE: 'LOCALHOST', 'RMW_IMPLEMENTATION': 'rmw_zenoh_cpp'}, (EVERYWHERE, 'LOCALHOST')),
    ],
)
def test_the_range_localhost_becomes_the_loopback_profile_unless_the_user_has_another(
    variables, expected
):
    assert chosen(**variables) == expected


def test_a_profile_in_the_working_directory_is_the_users_own(tmp_path, monkeypatch):
    monkeypatch.setenv('PYTHONPATH', str(FOLDER.parent))
    monkeypatch.chdir(tmp_path)
    (tmp_path / 'DEFAULT_FASTRTPS_PROFILES.xml').write_text(Path(EVERYWHERE).read_text())
    assert chosen(**{RANGE: 'LOCALHOST'}) == (EVERYWHERE, 'LOCALHOST')


def test_no_profile_that_a_child_finds_where_it_starts_takes_the_place_of_the_loopbacks(tmp_path):
    """It would let messages out; of a file that is skipped not even an error is said."""
    wrong = Path(EVERYWHERE).read_text().replace('leaseAnnouncement', 'leaseAnouncement')
    (tmp_path / 'DEFAULT_FASTRTPS_PROFILES.xml').write_text(wrong)
    code = f'import hexarm, os; os.chdir({str(tmp_path)!r}); {JOIN}'
    assert run(code, **{RANGE: 'LOCALHOST'}) == ''
    assert 'leaseAnouncement' in run(code, **{RANGE: 'SUBNET'})


@pytest.mark.parametrize('reach', ['LOCALHOST', 'SUBNET'])
def test_no_memory_is_shared_that_a_killed_process_could_leave_behind(reach):
    assert json.loads(run(MAPPED, **{RANGE: reach})) == []
