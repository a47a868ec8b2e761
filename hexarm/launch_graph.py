"""A machine's graph for `ros2 launch`: the processes of `hexarm up`, where ROS is installed."""

from pathlib import Path
from typing import Any

from launch import LaunchContext, LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess, OpaqueFunction
from launch.conditions import IfCondition
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

from hexarm.cli.running.up import MACHINES, check
from hexarm.graph import Executable, environment, machine_graph, ros_arguments

PACKAGE = 'hexarm'
PROGRAMS = {'machine': 'hexarm_machine', 'panel': 'hexarm_panel'}
"""Executables whose name in the package is not that in hexarm/nodes.py."""


def graph(kind: str) -> LaunchDescription:
    """The launch description of a hexapod or an arm; nothing moves before it is enabled."""
    arguments = {
        'machine': (MACHINES[kind], 'machine file: a shipped name or a path'),
        'port': ('fake', "a device, as /dev/serial/by-id/…, or 'fake' for the fake board"),
        'namespace': (kind, 'where the graph lives'),
        'frame_prefix': ('', 'prefix of the frames of tf and markers, as in hexapod/'),
        'panel': ('false', 'true: also the page to watch and drive it'),
    }
    declared = [
        DeclareLaunchArgument(name, default_value=default, description=meaning)
        for name, (default, meaning) in arguments.items()
    ]
    return LaunchDescription([*declared, OpaqueFunction(function=_nodes, args=[kind])])


def _nodes(context: LaunchContext, kind: str) -> list[Any]:
    """The processes; Refused or ConfigError for arguments that do not fit, before any starts."""
    machine, port, namespace, frame_prefix = (
        LaunchConfiguration(name).perform(context)
        for name in ('machine', 'port', 'namespace', 'frame_prefix')
    )
    check(kind, machine, namespace)
    space = namespace.strip('/')
    link = Path(f'/tmp/hexarm_{space.replace("/", "_")}')
    own = {'machine': {'frame_prefix': frame_prefix}}
    started = [
        _process(node, space, own.get(node.name, {}))
        for node in machine_graph(machine, port, link)
    ]
    panel = Node(
        package=PACKAGE,
        executable=PROGRAMS['panel'],
        namespace=space,
        parameters=[{'machine': machine}],
        output='screen',
        condition=IfCondition(LaunchConfiguration('panel')),
    )
    return [*started, panel]


def _process(node: Executable, namespace: str, own: dict[str, str]) -> Any:
    if node.command:
        words = [*node.command, *ros_arguments(namespace, node.parameters | own)]
        importable = {'PYTHONPATH': environment()['PYTHONPATH']}
        return ExecuteProcess(cmd=words, additional_env=importable, output='screen')
    return Node(
        package=PACKAGE,
        executable=PROGRAMS.get(node.name, node.name),
        namespace=namespace,
        parameters=[node.parameters | own],
        output='screen',
    )
