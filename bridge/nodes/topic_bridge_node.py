"""`serial_bridge` of a machine with `driver: topic`: joint commands to another driver, by topics.

It has the services and the machine states of the node with a board, so that no client can tell
them apart. The stop node's thread and the executor's share the driver: a lock takes turns.
"""

import threading
import time
from collections.abc import Callable

import numpy as np
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import JointState
from std_srvs.srv import SetBool, Trigger

from bridge.command_validator import Overtaken
from bridge.driver import MachineReport
from bridge.link_monitor import JointTable, MachineStatus
from bridge.nodes.board_topics import LEVELS, BoardTopics
from bridge.nodes.stop_node import StopNode
from bridge.stop_socket import StopSocket, stop_address
from bridge.topic_driver import TopicDriver
from manipulator.arrays import Array
from manipulator.deadlines import STATE_PERIOD
from manipulator.errors import ManipulatorError
from manipulator.machine import Machine
from manipulator.nodes.diagnostics import Diagnostics, Report
from manipulator.nodes.graph_check import received_by
from manipulator.nodes.intra_process import IntraProcess
from manipulator.nodes.late_answers import Call
from manipulator.nodes.messages import joint_message, known_joints, seconds
from manipulator.nodes.parameters import declare
from manipulator.nodes.qos import COMMAND
from manipulator.nodes.steady_timer import SteadyTimer
from manipulator.nodes.subscriptions import FilteredCallback

FAKE = 'fake'
"""The port of a simulated driver, whose joints are where they are commanded."""
SENT = 'driver/joint_command'
PERIOD = 0.02
"""Seconds between two looks at the deadlines and the stop socket, and between two joint states of
a simulated driver."""
SHORTEST = 0.008
"""Seconds between two joint states; a driver may report a thousand a second."""


class TopicBridge(Node):
    """Its topics, services and parameters are in docs/interfaces.md."""

    def __init__(
        self, load: Callable[[str], Machine], default_machine: str, process: IntraProcess
    ) -> None:
        super().__init__('serial_bridge')
        name = declare(self, 'machine', default_machine, 'name or path of the machine file')
        port = declare(
            self, 'port', FAKE, "topic of the driver's joint states, or 'fake' for none"
        )
        machine, is_simulated = load(name), port == FAKE
        epoch = time.time() - time.monotonic()
        self._driver = TopicDriver(machine, is_simulated, port, epoch)
        self._topics = BoardTopics(self, self._driver.names, port, process)
        self._lock = threading.RLock()
        self._published_at = self._command_at = float('-inf')
        self._beats_at = 0.0
        self._sent = self.create_publisher(JointState, SENT, COMMAND)
        self._joint_states = FilteredCallback(self, port, self._on_joints)
        if not is_simulated:
            self.create_subscription(JointState, port, self._joint_states, qos_profile_sensor_data)
        process.subscribe_unfiltered(
            self, JointState, 'joint_command', self._on_command, self._on_bad_command, COMMAND
        )
        self.create_service(SetBool, '~/enable', self._on_enable)
        self.create_service(Trigger, '~/clear_fault', self._on_clear_fault)
        self._stop_node = StopNode(self, self._stop, self._on_stop)
        address = stop_address(self.get_fully_qualified_name(), self.context.get_domain_id())
        self._stop_socket = StopSocket(address, self._stop)
        if self._stop_socket.problem:
            self.get_logger().warning(self._stop_socket.problem)
        self._timer = SteadyTimer(self, PERIOD, self._tick)
        beside = list(received_by(self._stop_node))
        self._diagnostics = Diagnostics(self, self._report, ('joint_command', SENT), beside)
        self._stop_node.start()

    def close(self) -> None:
        """Sends nothing more: the driver keeps the joints where they are."""
        self._stop_node.close()
        self._stop_socket.close()

    def _on_joints(self, message: JointState) -> None:
        now = time.monotonic()
        joints = known_joints(message, self._driver.names)
        with self._lock:
            if joints is None:
                self._driver.note_others(message.name)
                return
            self._driver.note_joints(joints, now)
            if now - self._published_at >= SHORTEST:
                self._publish_joints(_velocities(message, self._driver.names), now)
            self._publish_state(now)

    def _on_command(self, message: JointState) -> None:
        now = time.monotonic()
        try:
            stamp = seconds(message.header.stamp) or None
            with self._lock:
                self._command_at = now
                joints = self._driver.command(message.name, message.position, stamp, now)
                if not self._driver.is_simulated:
                    command = joint_message(joints, self._driver.names, message.header.stamp)
                    self._sent.publish(command)
                self._publish_state(now)
        except Overtaken as error:
            self.get_logger().debug(f'joint_command refused: {error}')
        except ManipulatorError as error:
            self._on_bad_command(error)

    def _on_bad_command(self, error: ManipulatorError) -> None:
        self._driver.refuse(str(error))
        self._topics.warn(f'joint_command refused: {error}')

    def _on_enable(self, request: SetBool.Request, response: SetBool.Response) -> object:
        return self._answered(response, lambda now: self._driver.enable(request.data, now))

    def _on_clear_fault(self, request: Trigger.Request, response: Trigger.Response) -> object:
        return self._answered(response, self._driver.clear_fault)

    def _on_stop(self, call: Call) -> None:
        self._stop()
        call.response.success = True
        call.response.message = 'stopped: ~/clear_fault ends it'
        call.send()

    def _stop(self) -> None:
        with self._lock:
            self._driver.stop()
            self._publish_state(time.monotonic())

    def _answered(self, response: object, act: Callable[[float], str]) -> object:
        now = time.monotonic()
        with self._lock:
            try:
                response.success, response.message = True, act(now)  # type: ignore[attr-defined]
            except ManipulatorError as error:
                response.success, response.message = False, str(error)  # type: ignore[attr-defined]
            self._publish_state(now)
        return response

    def _tick(self) -> None:
        self._stop_socket.receive()
        now = time.monotonic()
        with self._lock:
            if self._driver.is_simulated:
                self._publish_joints(np.zeros(len(self._driver.names)), now)
            self._publish_state(now)
            if now >= self._beats_at:
                self._beats_at = now + STATE_PERIOD
                self._topics.beat()

    def _publish_joints(self, velocities: Array, now: float) -> None:
        self._published_at = now
        if self._driver.joints is not None:
            self._topics.on_joints(JointTable(self._driver.joints, velocities))

    def _publish_state(self, now: float) -> MachineStatus:
        driver = self._driver
        status = driver.status(now)
        unknown = driver.names if driver.joints is None else ()
        board = 'none, driver: topic'
        is_measured = not driver.is_simulated
        self._topics.on_machine_state(
            MachineReport(status, driver.is_followed, is_measured, board, unknown)
        )
        return status

    def _report(self) -> Report:
        now = time.monotonic()
        with self._lock:
            status = self._driver.status(now)
        values: dict[str, object] = {
            'port': self.get_parameter('port').value,
            'last_command_age_s': now - self._command_at,
            'last_joint_states_age_s': self._joint_states.age,
            'joint_states_refused': self._joint_states.refused,
            'refusals': self._driver.refusals,
            'last_refusal': self._driver.last_refusal,
        }
        return LEVELS[status.level], status.reason or status.state, values


def _velocities(message: JointState, names: tuple[str, ...]) -> Array:
    """In the order of `names`; zeros where the driver reports none."""
    if len(message.velocity) != len(message.name):
        return np.zeros(len(names))
    return np.array([message.velocity[message.name.index(name)] for name in names])
