"""The node between the graph and the board: joint commands down, joint states up."""

import dataclasses
import time
from collections.abc import Callable
from typing import TypeVar

from rclpy.node import Node
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64
from std_srvs.srv import SetBool, Trigger

from bridge.driver import Asked, BoardDriver, MachineState
from bridge.latencies import Latencies
from bridge.link import Ticket
from bridge.link_monitor import JointTable
from bridge.link_thread import LinkThread
from bridge.machine_state_node import LEVELS, StateTopic
from bridge.programs_node import BoardPrograms
from bridge.serial_port import SerialPort
from bridge.servo_config import BoardConfig
from bridge.stop_memory import StopMemory, stop_file
from bridge.stop_node import StopNode, answer_of
from bridge.stop_socket import StopSocket, stop_address
from manipulator.errors import ManipulatorError
from manipulator.nodes.bounded import decoded
from manipulator.nodes.diagnostics import Diagnostics, Report
from manipulator.nodes.graph_check import received_by
from manipulator.nodes.messages import seconds
from manipulator.nodes.parameters import declare
from manipulator.nodes.qos import COMMAND, MEASUREMENT

SAY_AGAIN_AFTER = 2.0
_Response = TypeVar('_Response', SetBool.Response, Trigger.Response)
MOST_BYTES = 10_000
"""Of a joint_command: that of seven joints has less than 500."""


class SerialBridge(Node):
    """`serial_bridge`; its topics, services and parameters stand in docs/interfaces.md."""

    def __init__(self, board_config: Callable[[str], BoardConfig]) -> None:
        super().__init__('serial_bridge')
        machine = declare(self, 'machine', 'robocake', 'name or path of the machine file')
        self._port = declare(
            self, 'port', '/dev/ttyACM0', 'serial port of the board; /dev/serial/by-id/… is best'
        )
        baud = declare(
            self, 'baud', 0, 'bits per second; 0: the machine file says', (0, 4_000_000)
        )
        config = board_config(machine)
        line = dataclasses.replace(config.link, baud=baud or config.link.baud)
        config = dataclasses.replace(config, link=line)
        name = self.get_fully_qualified_name()
        self._memory = StopMemory(stop_file(name, self._port), self.get_logger().error)
        # Receipt times are monotonic, but read like the system's clock at the start.
        epoch = time.time() - time.monotonic()
        self._driver = BoardDriver(config, self, epoch, self._memory.is_kept)
        self._command_at: float | None = None
        self._receipt_to_frame, self._setpoint_to_frame = Latencies(), Latencies()
        self._link = LinkThread(lambda: SerialPort(self._port, line.baud), self._driver.link)
        programs = BoardPrograms(self, self._driver.calibration, self._driver.link.request)
        stops = StopNode(self, self._driver, self._remember)
        address = stop_address(name, self.context.get_domain_id())
        self._aside = programs, stops, StopSocket(address, stops.stop, self.get_logger().warning)
        self._make_interfaces()
        for part in (self._memory, self._link, *self._aside):
            part.start()

    def close(self) -> None:
        """Gives the port back; the board's deadline does what the machine file says."""
        for part in (*self._aside, self._link, self._memory):
            part.close()

    def _make_interfaces(self) -> None:
        self._joint_states = self.create_publisher(JointState, 'joint_states', MEASUREMENT)
        self._machine_state = StateTopic(self)
        self.create_subscription(JointState, 'joint_command', self._on_command, COMMAND, raw=True)
        self.create_subscription(Float64, 'gripper', self._on_gripper, COMMAND)
        self.create_service(SetBool, '~/enable', self._on_enable)
        self.create_service(Trigger, '~/clear_fault', self._on_clear_fault)
        nodes = [part for part in self._aside if isinstance(part, Node)]
        beside = [topic for node in nodes for topic in received_by(node)]
        self._diagnostics = Diagnostics(self, self._report, ('joint_command',), beside)

    # From the graph (the executor's thread)

    def _on_command(self, serialized: bytes) -> None:
        self._command_at = now = time.monotonic()
        try:
            message = decoded(serialized, JointState, MOST_BYTES)
            stamp = seconds(message.header.stamp) or None
            if stamp is None:
                self.get_logger().info('joint_command without a stamp: taken as now', once=True)
            self._driver.command(message.name, message.position, stamp, now)
        except ManipulatorError as error:
            self._driver.monitor.refuse(str(error))
            self._warn(f'joint_command refused: {error}')

    def _on_gripper(self, message: Float64) -> None:
        try:
            self._driver.aim_gripper(message.data)
        except ManipulatorError as error:
            self._warn(f'gripper refused: {error}')

    def _on_enable(self, request: SetBool.Request, response: SetBool.Response) -> SetBool.Response:
        return self._answered(self._driver.enable(request.data), response)

    def _on_clear_fault(
        self, request: Trigger.Request, response: Trigger.Response
    ) -> Trigger.Response:
        return self._answered(self._driver.clear_fault(), response)

    def _answered(self, asked: Asked, response: _Response) -> _Response:
        response.success, response.message = answer_of(self._driver, asked)
        return response

    # From the board (the link's thread)

    def on_joints(self, joints: JointTable) -> None:
        """Publishes the joints whose position is known."""
        known = [i for i, is_known in enumerate(joints.is_known) if is_known]
        message = JointState()
        message.header.stamp = self.get_clock().now().to_msg()
        message.name = [self._driver.calibration.names[i] for i in known]
        message.position = joints.positions[known].tolist()
        message.velocity = joints.velocities[known].tolist()
        message.effort = [0.0] * len(known)
        self._joint_states.publish(message)

    def on_machine_state(self, state: MachineState) -> None:
        """Publishes it when it has changed."""
        self._remember()
        values: dict[str, object] = {
            'reason': state.status.reason,
            'followed': 'yes' if state.is_followed else 'no',
            'port': self._port,
            'joints': 'measured' if state.is_measured else 'commanded',
            'board': state.board,
            'joints_unknown': ' '.join(state.unknown_joints),
        }
        self._machine_state.say(state.status, values)

    def on_trouble(self, text: str) -> None:
        """Logs it."""
        self._warn(text)

    def on_written(self, ticket: Ticket, now: float) -> None:
        """Counts what it took from the command to the frame."""
        self._receipt_to_frame.add(now - ticket.received)
        if ticket.stamped is not None and not self._driver.gate.has_notable_offset:
            self._setpoint_to_frame.add(time.time() - ticket.stamped)

    def _remember(self) -> None:
        """Keeps it for a bridge that starts after this one whether a STOP stands."""
        self._memory.keep(lambda: self._driver.session.is_stop_wanted)

    def _warn(self, text: str) -> None:
        self.get_logger().warning(text, throttle_duration_sec=SAY_AGAIN_AFTER)

    def _report(self) -> Report:
        if not self._link.is_alive():
            raise RuntimeError('the thread of the serial link has died')
        current = self._driver.monitor.status
        age = time.monotonic() - self._command_at if self._command_at is not None else None
        values: dict[str, object] = {
            'port': self._port,
            **self._setpoint_to_frame.report('setpoint_to_frame'),
            **self._receipt_to_frame.report('receipt_to_frame'),
            'last_command_age_s': 'none yet' if age is None else age,
            **self._driver.monitor.report(),
        }
        if self._driver.gate.has_notable_offset:
            values['joint_command_clock_offset_s'] = self._driver.gate.clock_offset
        return LEVELS[current.level], current.reason or current.word, values
