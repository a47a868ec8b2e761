"""`import hexarm` is cheap and needs no ROS; its names come when they are used."""

import subprocess
import sys

import pytest

import hexarm


def test_importing_hexarm_imports_neither_ros_nor_numpy():
    code = "import sys, hexarm; sys.exit(str({'rclpy', 'numpy', 'yaml'} & set(sys.modules)))"
    done = subprocess.run(
        [sys.executable, '-c', code], capture_output=True, text=True, check=False, timeout=60
    )
    assert done.stderr.strip() == 'set()'


def test_every_public_name_is_there():
    pytest.importorskip('rclpy')
    for name in hexarm.__all__:
        assert getattr(hexarm, name).__name__ == name


def test_another_name_is_none():
    with pytest.raises(AttributeError, match="no attribute 'Robto'"):
        _ = hexarm.Robto
