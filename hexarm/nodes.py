"""The executables of the nodes: `ros2 run hexarm NAME …`, `python -m hexarm.nodes NAME …`.

`hexapod_…` and `arm_…` differ in the machine that they run where none is named; as `trajectory`,
`ik` and `pose` they run either kind. An executable imports only its own node: imports are in the
functions.
"""

import signal
import sys
from functools import cache, partial
from importlib import import_module

from rclpy.node import Node

from hexarm.machines import described, load, read, saved_poses_file
from manipulator.errors import InvalidInput
from manipulator.nodes.intra_process import IntraProcess
from manipulator.nodes.run import Makers, run_nodes

HEXAPOD, ARM = 'robocake', 'arm_6r'
"""The machines of the executables where none is named."""


def _trajectory(machine: str, process: IntraProcess) -> Node:
    from manipulator.nodes.trajectory_node import TrajectoryNode

    return TrajectoryNode(_loaded, machine, process)


def _ik(machine: str, process: IntraProcess) -> Node:
    from manipulator.nodes.ik_node import IkNode

    return IkNode(_loaded, machine, process)


def _pose(machine: str, process: IntraProcess) -> Node:
    from manipulator.nodes.pose_node import PoseNode

    return PoseNode(_loaded, saved_poses_file, machine, process)


def _serial_bridge(process: IntraProcess) -> Node:
    """The node with a board, or without one: the machine file says which."""
    if read(_parameter('serial_bridge', 'machine', HEXAPOD)).driver == 'topic':
        from bridge.nodes.topic_bridge_node import TopicBridge

        return TopicBridge(_loaded, HEXAPOD, process)
    from bridge.nodes.serial_bridge_node import SerialBridge
    from hexarm.machines import board_config

    return SerialBridge(board_config, process)


def _parameter(node: str, name: str, default: str) -> str:
    """A parameter that a node of this process will have; rclpy tells it to a node alone."""
    from manipulator.nodes.parameters import declare

    reader = Node(node, enable_rosout=False, start_parameter_services=False)
    try:
        return str(declare(reader, name, default, ''))
    finally:
        reader.destroy_node()


_loaded = cache(load)
"""A machine file is read once, also where one process holds several nodes."""


def machine_nodes() -> Makers:
    """What makes the four nodes of a machine: trajectory, ik, pose, serial_bridge."""
    process = IntraProcess()
    parts = (partial(part, HEXAPOD, process) for part in (_trajectory, _ik, _pose))
    return [*parts, partial(_serial_bridge, process)]


def import_machine_nodes() -> None:
    """Imports what the four nodes of a machine consist of, so that making them takes less."""
    for name in ('trajectory', 'ik', 'pose'):
        import_module(f'manipulator.nodes.{name}_node')
    import_module('bridge.nodes.serial_bridge_node')


def machine() -> int:
    """Runs the four nodes of a machine in one process."""
    return run_nodes(machine_nodes(), described)


def trajectory(default_machine: str = HEXAPOD) -> int:
    """Runs the trajectory node."""
    return run_nodes([partial(_trajectory, default_machine, IntraProcess())], described)


def ik(default_machine: str = HEXAPOD) -> int:
    """Runs the inverse kinematics node."""
    return run_nodes([partial(_ik, default_machine, IntraProcess())], described)


def pose(default_machine: str = HEXAPOD) -> int:
    """Runs the forward kinematics node."""
    return run_nodes([partial(_pose, default_machine, IntraProcess())], described)


arm_trajectory, arm_ik, arm_pose = (partial(run, ARM) for run in (trajectory, ik, pose))


def serial_bridge() -> int:
    """Runs the node between the graph and the board."""
    return run_nodes([partial(_serial_bridge, IntraProcess())], described)


def fake_hardware() -> int:
    """Runs a board on a pty."""
    from bridge.fake.fake_hardware_node import FakeHardware
    from hexarm.board.plant import fake_machine
    from hexarm.machines import board_config

    return run_nodes([lambda: FakeHardware(board_config, fake_machine)], described)


def joy_teleop() -> int:
    """Runs the node from Joy messages to jog commands."""
    from hexarm.gamepads import load
    from manipulator.nodes.devices.joy_teleop_node import JoyTeleop

    return run_nodes([lambda: JoyTeleop(load)])


def gamepad() -> int:
    """Runs the node from a pad of this computer to Joy messages."""

    def make() -> Node:
        from manipulator.nodes.devices.gamepad_node import Gamepad  # needs evdev

        return Gamepad()

    return run_nodes([make])


def keyboard_teleop() -> int:
    """Runs the node from a terminal's keys to jog commands."""
    from manipulator.nodes.devices.keyboard_teleop_node import KeyboardTeleop
    from manipulator.nodes.devices.terminal import Terminal

    signal.signal(signal.SIGHUP, signal.SIG_IGN)  # a closed window is seen when reading
    try:
        with Terminal() as terminal:
            return run_nodes([lambda: KeyboardTeleop(terminal)])
    except InvalidInput as error:
        print(f'keyboard_teleop: {error}', file=sys.stderr)
        return 1


def panel() -> int:
    """Serves the web page of one machine."""

    def make() -> Node:
        from hexarm.panel.nodes.panel_node import PanelNode  # needs viser

        return PanelNode(load, HEXAPOD)

    return run_nodes([make], described)


NAMES = {
    'machine': machine,
    'trajectory': trajectory,
    'ik': ik,
    'pose': pose,
    'serial_bridge': serial_bridge,
    'fake_hardware': fake_hardware,
    'joy_teleop': joy_teleop,
    'keyboard_teleop': keyboard_teleop,
    'gamepad': gamepad,
    'panel': panel,
}


def main() -> int:
    """`python -m hexarm.nodes NAME …`: runs the executable of that name; status 2 without one."""
    name = sys.argv[1] if len(sys.argv) > 1 else ''
    if name not in NAMES:
        print(f'needs one of the names {", ".join(NAMES)}', file=sys.stderr)
        return 2
    sys.argv[:2] = [name]
    return NAMES[name]()


if __name__ == '__main__':
    sys.exit(main())
