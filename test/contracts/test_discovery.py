"""Processes announce themselves as often as the profile says, or as the user's own does."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

import hexarm

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
