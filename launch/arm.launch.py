"""ros2 launch hexarm arm.launch.py; docs/viewers.md lists its arguments."""

from launch import LaunchDescription

from hexarm.launch_graph import graph


def generate_launch_description() -> LaunchDescription:
    """The graph of an arm; `--show-args` tells what can be chosen."""
    return graph('arm')
