"""Messages for libraries that only some commands need, where they are not installed."""

INSTALL = {
    'ruckig': 'python3 -m pip install ruckig',
    'serial': 'python3 -m pip install pyserial',
    'evdev': 'python3 -m pip install evdev, or apt install python3-evdev (Linux)',
    'matplotlib': 'python3 -m pip install matplotlib',
    'mujoco': 'python3 -m pip install mujoco',
    'foxglove': 'python3 -m pip install foxglove-sdk',
    'rich': 'python3 -m pip install rich',
    'mcap': 'python3 -m pip install mcap',
    'mcap_ros2': 'python3 -m pip install mcap-ros2-support',
    'PIL': 'python3 -m pip install pillow',
    'viser': "python3 -m pip install 'viser>=1.1,<1.2'",
    'scipy': 'python3 -m pip install scipy, or apt install python3-scipy',
    'rclpy': 'install ROS 2 Jazzy and source its setup.bash, or pip install hexarm[ros]',
}


def missing(error: ModuleNotFoundError) -> str:
    """One sentence with the remedy; the error of any other module is raised again."""
    name = (error.name or '').split('.')[0]
    if name not in INSTALL:
        raise error
    return f'needs the Python module {name}: {INSTALL[name]}'
