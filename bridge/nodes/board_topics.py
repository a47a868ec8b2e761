"""What serial_bridge publishes of its board: `joint_states` and `machine_state`."""

import time
from collections.abc import Mapping, Sequence

from diagnostic_msgs.msg import DiagnosticStatus
from rclpy.node import Node
from sensor_msgs.msg import JointState

from bridge.driver import MachineReport
from bridge.link import Ticket
from bridge.link_monitor import JointTable, Latencies, MachineStatus
from manipulator.nodes.diagnostics import ERROR, OK, WARN, status
from manipulator.nodes.intra_process import IntraProcess
from manipulator.nodes.qos import LATCHED, MEASUREMENT

LEVELS = (OK, WARN, ERROR)
WARN_AGAIN_AFTER = 2.0


class BoardTopics:
    """The driver's listener; in the link's thread only."""

    def __init__(self, node: Node, names: Sequence[str], port: str, process: IntraProcess) -> None:
        """`names` are those of the calibration, `port` what `machine_state` names."""
        self._node, self._names, self._port = node, names, port
        self._joint_states = process.publisher(
            node, JointState, 'joint_states', MEASUREMENT, is_from_thread=True
        )
        self._states = node.create_publisher(DiagnosticStatus, 'machine_state', LATCHED)
        self._state: tuple[MachineStatus, Mapping[str, object]] | None = None
        self._message: DiagnosticStatus | None = None
        self._receipt_to_frame, self._setpoint_to_frame = Latencies(), Latencies()

    def on_joints(self, joints: JointTable) -> None:
        """Publishes the joints whose position is known."""
        known = [i for i, is_known in enumerate(joints.is_known) if is_known]
        message = JointState()
        message.header.stamp = self._node.get_clock().now().to_msg()
        message.name = [self._names[i] for i in known]
        message.position = joints.positions[known].tolist()
        message.velocity = joints.velocities[known].tolist()
        message.effort = [0.0] * len(known)
        self._joint_states.publish(message)

    def on_machine_state(self, state: MachineReport) -> None:
        """Publishes it when it has changed."""
        current = state.status
        values: dict[str, object] = {
            'reason': current.reason,
            'followed': 'yes' if state.is_followed else 'no',
            'port': self._port,
            'joints': 'measured' if state.is_measured else 'commanded',
            'board': state.board,
            'joints_unknown': ' '.join(state.unknown_joints),
        }
        if (current, values) == self._state:
            return
        if self._state is None or self._state[0] != current:
            reason = f' ({current.reason})' if current.reason else ''
            self._node.get_logger().info(f'machine {current.state}{reason}')
        self._state = current, values
        name = f'{self._node.get_name()}: machine state'
        self._message = status(LEVELS[current.level], name, current.state, values)
        self._states.publish(self._message)

    def on_problem(self, text: str) -> None:
        """Logs it."""
        self.warn(text)

    def on_written(self, ticket: Ticket, now: float) -> None:
        """Counts what it took from the command to the frame."""
        self._receipt_to_frame.add(now - ticket.received)
        if ticket.stamped is not None:
            self._setpoint_to_frame.add(time.time() - ticket.stamped)

    def beat(self) -> None:
        """Publishes the machine's state again: a subscriber knows by it that the bridge lives."""
        if self._message is not None:
            self._states.publish(self._message)

    def warn(self, text: str) -> None:
        """Logs what went wrong, every two seconds at most."""
        self._node.get_logger().warning(text, throttle_duration_sec=WARN_AGAIN_AFTER)

    def report(self) -> dict[str, object]:
        """For /diagnostics: how long commands take to the frame."""
        return {
            **self._setpoint_to_frame.report('setpoint_to_frame'),
            **self._receipt_to_frame.report('receipt_to_frame'),
        }
