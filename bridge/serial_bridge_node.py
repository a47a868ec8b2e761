"""The node between the graph and the board: joint commands down, joint states up."""

import time

from rclpy.node import Node
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64
from std_srvs.srv import SetBool, Trigger

from bridge.board_answers import BoardAnswers
from bridge.calibration import Calibration
from bridge.command_gate import CommandGate
from bridge.events import (
    CommandFailed,
    Disconnected,
    Event,
    FaultReported,
    Incompatible,
    StateReceived,
)
from bridge.gripper import Gripper
from bridge.latencies import Latencies
from bridge.link_monitor import LinkMonitor
from bridge.link_thread import LinkThread, Ticket
from bridge.machine_state_node import LEVELS, StateTopic
from bridge.messages import Arm, Clear, Command, Disarm
from bridge.programs_node import BoardPrograms
from bridge.serial_port import SerialPort
from bridge.servo_config import BoardConfig
from bridge.session import Session
from bridge.stop_memory import StopMemory, stop_file
from bridge.stop_node import StopNode
from bridge.stop_socket import StopSocket, stop_address
from hexarm import machines
from manipulator.errors import ManipulatorError, Refused
from manipulator.nodes.bounded import decoded
from manipulator.nodes.diagnostics import Diagnostics, Report
from manipulator.nodes.graph_check import received_by
from manipulator.nodes.messages import seconds
from manipulator.nodes.parameters import declare
from manipulator.nodes.qos import COMMAND, MEASUREMENT

SAY_AGAIN_AFTER = 2.0
MOST_BYTES = 10_000
"""Of a joint_command: that of seven joints has less than 500."""


class SerialBridge(Node):
    """`serial_bridge`; its topics, services and parameters stand in docs/interfaces.md."""

    def __init__(self) -> None:
        super().__init__('serial_bridge')
        machine = declare(self, 'machine', 'robocake', 'name or path of the machine file')
        self._port = declare(
            self, 'port', '/dev/ttyACM0', 'serial port of the board; /dev/serial/by-id/… is best'
        )
        baud = declare(
            self, 'baud', 0, 'bits per second; 0: the machine file says', (0, 4_000_000)
        )
        config = BoardConfig.from_machine(machines.read(machine), str(machines.find(machine)))
        self._baud = baud or config.link.baud
        self._calibration = Calibration.from_config(config.servos)
        self._gate = CommandGate(self._calibration, 1e-3 * config.link.setpoint_deadline_ms)
        self._gripper = Gripper(config.servos, self._calibration)
        self._memory = StopMemory(
            stop_file(self.get_fully_qualified_name(), self._port), self.get_logger().error
        )
        self._session = Session(len(self._calibration.names), self._memory.is_kept)
        self._monitor = LinkMonitor(self._session, self._calibration)
        # Receipt times are monotonic, but read like the system's clock at the start.
        self._clock_start = time.time() - time.monotonic()
        self._command_at: float | None = None
        self._receipt_to_frame, self._setpoint_to_frame = Latencies(), Latencies()
        self._is_followed = False
        self._link = LinkThread(
            lambda: SerialPort(self._port, self._baud),
            self._session,
            self._on_event,
            self._on_written,
            bytes_per_second=self._baud / 5,  # twice what the line carries
        )
        self._answers = BoardAnswers(self._link.request, lambda: self._monitor.trouble)
        programs = BoardPrograms(self, self._calibration, self._link.request)
        stops = StopNode(self, self._link, self._answers, self._remember)
        address = stop_address(self.get_fully_qualified_name(), self.context.get_domain_id())
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
        self._command_at = time.monotonic()
        try:
            message = decoded(serialized, JointState, MOST_BYTES)
            self._refuse_unless_enabled()
            self._link.put_setpoint(self._admitted(message, self._command_at))
        except ManipulatorError as error:
            self._monitor.refuse(str(error))
            self._warn(f'joint_command refused: {error}')

    def _admitted(self, message: JointState, now: float) -> Ticket:
        stamp = seconds(message.header.stamp) or None
        if stamp is None:
            self.get_logger().info('joint_command without a stamp: taken as now', once=True)
        present = None if self._monitor.joints is None else self._monitor.joints.positions
        names, positions = self._gripper.joined((message.name, message.position), now, present)
        setpoint = self._gate.admit(names, positions, stamp, now + self._clock_start, present)
        return Ticket(setpoint, now, stamp)

    def _refuse_unless_enabled(self) -> None:
        if not (self._monitor.is_enabled_here and self._session.accepts_setpoints):
            self._restart()
            current = self._monitor.status
            raise Refused(f'{current.word}{f" ({current.reason})" if current.reason else ""}')

    def _restart(self) -> None:
        """What comes next must start where the joints are."""
        self._gate.restart()
        self._gripper.restart()

    def _on_gripper(self, message: Float64) -> None:
        try:
            self._refuse_unless_enabled()
            self._gripper.aim(message.data)
        except ManipulatorError as error:
            self._warn(f'gripper refused: {error}')

    def _on_enable(self, request: SetBool.Request, response: SetBool.Response) -> SetBool.Response:
        if request.data and self._monitor.status.word == 'enabled':
            # An ARM would hold up the setpoints of a machine that is moving.
            response.success, response.message = True, 'enabled already'
        elif request.data:
            park = self._calibration.counts(self._calibration.park)
            done = 'arming: the servos go to park one by one'
            response.success, response.message = self._ask(Arm(park), done)
        else:
            response.success, response.message = self._ask(Disarm(), 'disarmed: no more pulses')
        return response

    def _on_clear_fault(
        self, request: Trigger.Request, response: Trigger.Response
    ) -> Trigger.Response:
        if self._monitor.is_clear:
            # A CLEAR would hold up the setpoints of a machine that is moving.
            word = self._monitor.status.word
            response.success, response.message = True, f'nothing to clear: the machine is {word}'
        else:
            done = 'cleared: nothing moves until a new command'
            response.success, response.message = self._ask(Clear(), done)
        return response

    def _ask(self, command: Command, done: str) -> tuple[bool, str]:
        is_obeyed, said = self._answers.ask(command, done)
        if is_obeyed:
            self._restart()
        return is_obeyed, said

    # From the board (the link's thread)

    def _on_event(self, event: Event) -> None:
        now = time.monotonic()
        self._monitor.note(event, now)
        self._remember()
        match event:
            case StateReceived():
                self._publish_joints()
            case FaultReported():
                self._warn(self._monitor.last_refusal)
            case CommandFailed(command, reason):
                self._warn(f'{type(command).__name__.upper()}: {reason}')
            case Disconnected(reason) | Incompatible(reason):
                self._warn(reason)
        self._publish_status()

    def _remember(self) -> None:
        """Keeps it for a bridge that starts after this one whether a STOP stands."""
        self._memory.keep(lambda: self._session.is_stop_wanted)

    def _on_written(self, ticket: Ticket, now: float) -> None:
        self._is_followed = True
        self._receipt_to_frame.add(now - ticket.received)
        if ticket.stamped is not None and not self._gate.has_notable_offset:
            self._setpoint_to_frame.add(time.time() - ticket.stamped)

    def _publish_joints(self) -> None:
        joints = self._monitor.joints
        if joints is None or not any(joints.is_known):
            return
        known = [i for i, is_known in enumerate(joints.is_known) if is_known]
        message = JointState()
        message.header.stamp = self.get_clock().now().to_msg()
        message.name = [self._calibration.names[i] for i in known]
        message.position = joints.positions[known].tolist()
        message.velocity = joints.velocities[known].tolist()
        message.effort = [0.0] * len(known)
        self._joint_states.publish(message)

    def _publish_status(self) -> None:
        """Publishes the machine's state when it has changed."""
        current = self._monitor.status
        self._is_followed = self._is_followed and current.word == 'enabled'
        values: dict[str, object] = {
            'reason': current.reason,
            'followed': 'yes' if self._is_followed else 'no',
            'port': self._port,
            'joints': 'measured' if self._monitor.is_measured else 'commanded',
            'board': self._monitor.board,
            'joints_unknown': ' '.join(self._monitor.unknown_joints),
        }
        self._machine_state.say(current, values)

    def _warn(self, text: str) -> None:
        self.get_logger().warning(text, throttle_duration_sec=SAY_AGAIN_AFTER)

    def _report(self) -> Report:
        if not self._link.is_alive():
            raise RuntimeError('the thread of the serial link has died')
        current = self._monitor.status
        age = time.monotonic() - self._command_at if self._command_at is not None else None
        values: dict[str, object] = {
            'port': self._port,
            **self._setpoint_to_frame.report('setpoint_to_frame'),
            **self._receipt_to_frame.report('receipt_to_frame'),
            'last_command_age_s': 'none yet' if age is None else age,
            **self._monitor.report(),
        }
        if self._gate.has_notable_offset:
            values['joint_command_clock_offset_s'] = self._gate.clock_offset
        return LEVELS[current.level], current.reason or current.word, values
