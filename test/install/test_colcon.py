"""A colcon workspace: what is installed where, and a graph that runs from there."""

import json
import os
import subprocess
import time

import pytest
from ament_index_python.packages import get_package_prefix, get_package_share_directory
from geometry_msgs.msg import PoseStamped

from manipulator.nodes.messages import pose_of
from manipulator.nodes.qos import MEASUREMENT
from manipulator.pose import Pose
from patient_user import PatientUser

NAMESPACE = 'installed'
PATIENCE = 60.0


@pytest.fixture
def ros2_run(colcon_prefix, colcon_environment, tmp_path):
    """Starts executables as `ros2 run hexarm …` does, far from the source tree."""
    started = []

    def start(executable, **parameters):
        words = [colcon_prefix / 'lib' / 'hexarm' / executable, '--ros-args']
        words += ['-r', f'__ns:=/{NAMESPACE}']
        for name, value in parameters.items():
            words += ['-p', f'{name}:={value}']
        started.append(subprocess.Popen(words, cwd=tmp_path, env=colcon_environment))

    yield start
    statuses = []
    for process in reversed(started):  # one by one: DDS leaves late where all leave at once
        process.terminate()
        statuses.append(process.wait(PATIENCE))
    assert statuses == [0] * len(started)


def test_ament_index_knows_the_package(colcon_prefix, colcon_environment, monkeypatch):
    monkeypatch.setenv('AMENT_PREFIX_PATH', colcon_environment['AMENT_PREFIX_PATH'])
    assert get_package_prefix('hexarm') == str(colcon_prefix)
    share = get_package_share_directory('hexarm')
    assert share == str(colcon_prefix / 'share' / 'hexarm')
    assert os.path.isfile(os.path.join(share, 'package.xml'))


def test_every_executable_is_where_ros2_run_looks(colcon_prefix, executables):
    folder = colcon_prefix / 'lib' / 'hexarm'
    assert executables >= {'hexarm', 'hexapod_ik', 'serial_bridge', 'fake_hardware'}
    assert {f.name for f in folder.iterdir() if os.access(f, os.X_OK)} == executables


def test_launch_files_and_layouts_are_in_share(colcon_prefix):
    share = colcon_prefix / 'share' / 'hexarm'
    assert {f.name for f in (share / 'launch').iterdir()} == {
        'hexapod.launch.py',
        'arm.launch.py',
    }
    assert {f.suffix for f in (share / 'viewers').iterdir()} == {'.json', '.rviz'}


def test_machine_files_are_found_in_share(colcon_prefix, colcon_environment, machines, run):
    command = colcon_prefix / 'lib' / 'hexarm' / 'hexarm'
    answer = json.loads(run(command, 'machines', '--json', env=colcon_environment, cwd='/'))
    found = {entry['name']: entry['path'] for entry in answer['machines']}
    assert found.keys() == machines
    config = colcon_prefix / 'share' / 'hexarm' / 'config'
    assert found['robocake'] == str(config / 'robocake.yaml')


def test_goal_moves_the_graph_that_was_started_from_the_workspace(ros2_run, tmp_path):
    port = tmp_path / 'board'
    ros2_run('fake_hardware', link=port)
    for executable in ('hexapod_ik', 'hexapod_pose', 'hexapod_trajectory'):
        ros2_run(executable)
    deadline = time.monotonic() + PATIENCE
    while not port.exists() and time.monotonic() < deadline:
        time.sleep(0.01)
    ros2_run('serial_bridge', port=port)

    poses = []
    with PatientUser(NAMESPACE) as client:
        client.node.create_subscription(PoseStamped, 'pose', poses.append, MEASUREMENT)
        client.make_ready()
        client.reach(Pose.from_xyz_rpy((0.004, 0.0, 0.045)))
        client.wait(
            'the platform at x = 4 mm',
            lambda: poses and abs(pose_of(poses[-1]).position[0] - 0.004) < 0.0005,
            PATIENCE,
        )
