"""The node between the graph and the board: joint commands down, joint states up.

The executor only hands over: what concerns the board is done in the thread of the link, which
answers services when the board has. So no callback waits, and other nodes may share the executor.
"""

import dataclasses
import time
from collections import deque
from collections.abc import Callable
from concurrent.futures import Future
from functools import partial

from rclpy.node import Node
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64
from std_srvs.srv import SetBool, Trigger

from bridge.calibration import Calibration
from bridge.command_validator import Overtaken
from bridge.driver import BoardDriver, Request
from bridge.link_thread import LinkThread, SerialPort
from bridge.nodes.board_topics import LEVELS, BoardTopics
from bridge.nodes.program_topics import ProgramTopics
from bridge.nodes.stop_node import StopNode
from bridge.servo_config import BoardConfig
from bridge.stop_socket import StopSocket, stop_address
from manipulator.deadlines import STATE_PERIOD
from manipulator.errors import InvalidInput, ManipulatorError
from manipulator.nodes.diagnostics import Diagnostics, Report
from manipulator.nodes.graph_check import received_by
from manipulator.nodes.intra_process import IntraProcess
from manipulator.nodes.late_answers import Call, create_late_service
from manipulator.nodes.messages import seconds
from manipulator.nodes.parameters import declare
from manipulator.nodes.qos import COMMAND
from manipulator.nodes.steady_timer import SteadyTimer


class SerialBridge(Node):
    """`serial_bridge`; its topics, services and parameters are in docs/interfaces.md."""

    def __init__(self, board_config: Callable[[str], BoardConfig], process: IntraProcess) -> None:
        super().__init__('serial_bridge')
        machine = declare(self, 'machine', 'robocake', 'name or path of the machine file')
        port = declare(
            self, 'port', '/dev/ttyACM0', 'serial port of the board; /dev/serial/by-id/… is best'
        )
        baud = declare(
            self, 'baud', 0, 'bits per second; 0: that of the machine file', (0, 4_000_000)
        )
        config = board_config(machine)
        line = dataclasses.replace(config.link, baud=baud or config.link.baud)
        config = dataclasses.replace(config, link=line)
        calibration = Calibration.from_config(config.servos)
        self._port = port
        self._topics = BoardTopics(self, calibration.names, port, process)
        # Receipt times are monotonic, but read like the system's clock at the start.
        self._driver = BoardDriver(config, self._topics, time.time() - time.monotonic())
        address = stop_address(self.get_fully_qualified_name(), self.context.get_domain_id())
        self._stop_socket = StopSocket(address, self._stop)
        if self._stop_socket.problem:
            self.get_logger().warning(self._stop_socket.problem)
        self._link = LinkThread(
            lambda: SerialPort(port, line.baud), self._driver.link, [self._stop_socket]
        )
        self._stop_node = StopNode(self, lambda: self._link.post(self._stop), self._on_stop)
        self._programs = ProgramTopics(self, calibration, self._driver.link, self._link.post)
        self._commands: deque[tuple[JointState, float]] = deque(maxlen=1)  # the newest counts
        self._command_at: float | None = None
        self._reported = self._report_of_link()
        self._make_interfaces(process)
        self._link.start()
        self._stop_node.start()

    def close(self) -> None:
        """Closes the port; the board's deadline then has the effect set by `on_link_loss`."""
        self._stop_node.close()
        self._link.close()
        self._stop_socket.close()

    def _make_interfaces(self, process: IntraProcess) -> None:
        process.subscribe_unfiltered(
            self, JointState, 'joint_command', self._on_command, self._on_bad_command, COMMAND
        )
        self.create_subscription(Float64, 'gripper', self._on_gripper, COMMAND)
        create_late_service(self, Trigger, '~/clear_fault', self._on_clear_fault)
        create_late_service(self, SetBool, '~/enable', self._on_enable)
        self._heartbeat = SteadyTimer(self, STATE_PERIOD, lambda: self._link.post(self._beat))
        received_beside = received_by(self._stop_node)
        self._diagnostics = Diagnostics(
            self, self._report, ('joint_command',), list(received_beside)
        )

    # In the executor's thread, or the stop node's

    def _on_command(self, message: JointState) -> None:
        self._commands.append((message, time.monotonic()))
        self._link.post(self._take_commands)

    def _on_bad_command(self, error: InvalidInput) -> None:
        self._link.post(partial(self._refuse_command, error))

    def _on_gripper(self, message: Float64) -> None:
        self._link.post(partial(self._aim_gripper, message.data))

    def _on_stop(self, call: Call) -> None:
        self._answer(call, self._driver.stop)

    def _on_clear_fault(self, call: Call) -> None:
        self._answer(call, self._driver.clear_fault)

    def _on_enable(self, call: Call) -> None:
        self._answer(call, partial(self._driver.enable, call.request.data))

    def _answer(self, call: Call, send: Callable[[], Request]) -> None:
        """Sends the request in the link's thread, and answers there as soon as the board has."""

        def begin() -> None:
            request = send()
            request.future.add_done_callback(lambda done: answer(request))

        def answer(request: Request) -> None:
            call.response.success, call.response.message = self._driver.answer(request)
            call.send()

        self._link.post(begin)

    def _report(self) -> Report:
        if not self._link.is_alive():
            raise RuntimeError('the thread of the serial link has died')
        return self._reported

    # In the link's thread

    def _stop(self) -> None:
        self._driver.stop().future.add_done_callback(self._warn_of_failed_stop)

    def _warn_of_failed_stop(self, done: 'Future[None]') -> None:
        error = done.exception()
        if error is not None:
            text = f'STOP not acknowledged, retrying: {error}'
            self.get_logger().error(text, throttle_duration_sec=1.0)

    def _take_commands(self) -> None:
        while self._commands:
            message, self._command_at = self._commands.popleft()
            try:
                self._take_command(message, self._command_at)
            except Overtaken as error:
                self.get_logger().debug(f'joint_command refused: {error}')
            except ManipulatorError as error:
                self._refuse_command(error)

    def _refuse_command(self, error: ManipulatorError) -> None:
        self._driver.monitor.refuse(str(error))
        self._topics.warn(f'joint_command refused: {error}')

    def _take_command(self, message: JointState, now: float) -> None:
        stamp = seconds(message.header.stamp) or None
        if stamp is None:
            self.get_logger().info('joint_command without a stamp: taken as now', once=True)
        self._driver.command(message.name, message.position, stamp, now)

    def _aim_gripper(self, opening: float) -> None:
        try:
            self._driver.aim_gripper(opening)
        except ManipulatorError as error:
            self._topics.warn(f'gripper refused: {error}')

    def _beat(self) -> None:
        self._topics.beat()
        self._reported = self._report_of_link()

    def _report_of_link(self) -> Report:
        monitor, validator = self._driver.monitor, self._driver.validator
        current = monitor.status
        age = time.monotonic() - self._command_at if self._command_at is not None else None
        values: dict[str, object] = {
            'port': self._port,
            **self._topics.report(),
            'last_command_age_s': 'none yet' if age is None else age,
            **monitor.report(),
        }
        if validator.has_notable_offset:
            values['joint_command_clock_offset_s'] = validator.clock_offset
        return LEVELS[current.level], current.reason or current.state, values
