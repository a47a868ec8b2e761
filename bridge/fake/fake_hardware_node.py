"""The fake board as a process: a pty that the shipped serial_bridge opens like any port."""

import math
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

from rcl_interfaces.msg import SetParametersResult
from rclpy.clock import Clock, ClockType
from rclpy.node import Node
from rclpy.parameter import Parameter
from sensor_msgs.msg import JointState
from std_srvs.srv import SetBool, Trigger

from bridge.fake.board_thread import BoardThread, FakeMachine
from bridge.fake.fake_line import FakeLine
from bridge.fake.faults import FaultKind, Faults
from bridge.protocol import ResetCause
from bridge.servo_config import BoardConfig, SimulationConfig
from manipulator.arrays import Array
from manipulator.errors import InvalidInput, LinkError
from manipulator.formatting import not_one_of
from manipulator.nodes.parameters import declare
from manipulator.nodes.qos import MEASUREMENT

PRESETS: dict[str, Callable[[SimulationConfig], SimulationConfig]] = {
    'normal': lambda simulation: simulation,
    'bad_day': lambda simulation: replace(
        simulation,
        hysteresis_deg=6 * simulation.hysteresis_deg,
        hysteresis_mm=6 * simulation.hysteresis_mm,
    ),
    'stepper': lambda simulation: replace(
        simulation,
        hysteresis_deg=0.0,
        hysteresis_mm=0.0,
        dead_band_us=0.0,
        joints='measured',
        drives='steppers',
    ),
}
"""bad_day: six times the play, so 3° on a worn RoboCake. stepper: no play, encoders, and a motion
controller that interpolates all joints together."""
PRESET = "'normal', 'bad_day' (six times the play) or 'stepper' (no play, measured joints)"


KINDS = [kind.value for kind in FaultKind]
SEED = 'of the random faults: the same seed brings the same ones after the same seconds'
PER_MINUTE = 'random faults in 60 s, on average'
MakeMachine = Callable[[str, BoardConfig, float, float, str, Callable[[str], object]], FakeMachine]
"""Makes the fake machine of a machine file's name or path: its configuration, the silence after a
reset in s, the play of its joints in rad or m, what moves them, what receives its speed."""


class FakeHardware(Node):
    """`fake_hardware`; its topics, services and parameters stand in docs/interfaces.md."""

    def __init__(self, board_config: Callable[[str], BoardConfig], make: MakeMachine) -> None:
        super().__init__('fake_hardware')
        name = declare(self, 'machine', 'robocake', 'name or path of the machine file')
        link = declare(self, 'link', '/tmp/hexarm_board', 'where the port appears: a symlink')
        boot_s = declare(
            self,
            'boot_s',
            0.3,
            'silence after a reset, in seconds; a Mega: 1 to 2',
            (0.0, 10.0),
        )
        preset = declare(self, 'preset', 'normal', PRESET)
        own = declare(
            self,
            'hysteresis_deg',
            -1.0,
            'play of each servo in degrees; -1: as machine file and preset say',
            (-1.0, 45.0),
        )
        moved = declare(self, 'plant', 'servo', "'servo', or 'mujoco': loads, torque limits")
        if preset not in PRESETS:
            raise InvalidInput(f'parameter preset: {not_one_of(preset, PRESETS)}')
        config = board_config(name)
        config = replace(config, simulation=PRESETS[preset](config.simulation))
        hysteresis = math.radians(own) if own >= 0 else config.hysteresis
        machine = make(name, config, boot_s, hysteresis, moved, self.get_logger().info)
        self._names = machine.calibration.names
        self._path = Path(link)
        self._board = machine.board
        self._add_battery(config.simulation)
        self._true_joints = self.create_publisher(JointState, 'true_joint_states', MEASUREMENT)
        self.create_service(Trigger, '~/reset', self._on_reset)
        self.create_service(SetBool, '~/plug', self._on_plug)
        self.create_service(SetBool, '~/mute', self._on_mute)
        self.create_service(SetBool, '~/stop_pin', self._on_stop_pin)
        self._faults = self._declare_faults()
        line = FakeLine(self._path)
        self._thread = BoardThread(machine, line, self._publish, self._faults)
        self._begin = self.create_timer(
            0.0, self._on_begin, clock=Clock(clock_type=ClockType.STEADY_TIME)
        )
        self.get_logger().info(f'board on {self._path}')

    def _on_begin(self) -> None:
        """Only once the node is spun: what is done before would leave a host without answers."""
        self._begin.cancel()
        self._thread.start()

    def close(self) -> None:
        """Removes the port."""
        self._thread.close()

    def _add_battery(self, simulation: SimulationConfig) -> None:
        description = 'battery voltage that the board measures, in volts'
        declare(self, 'battery_v', simulation.battery_v, description, (0.0, 60.0), False)
        self.add_on_set_parameters_callback(self._on_parameters)

    def _declare_faults(self) -> Faults:
        seed = declare(self, 'faults_seed', 0, SEED, (0, 2**31 - 1))
        per_minute = declare(self, 'faults_per_minute', 0.0, PER_MINUTE, (0.0, 600.0))
        declare(
            self, 'fault', '', f'set to one of {", ".join(KINDS)}: it happens once', None, False
        )
        return Faults(seed, per_minute)

    def _on_parameters(self, parameters: list[Parameter]) -> SetParametersResult:
        for parameter in parameters:
            if parameter.name == 'battery_v':
                self._board.battery_mv = round(1000 * float(parameter.value))
            elif parameter.name == 'fault' and parameter.value:
                if parameter.value not in KINDS:
                    reason = f'fault: {not_one_of(parameter.value, KINDS)}'
                    return SetParametersResult(successful=False, reason=reason)
                self._faults.inject(FaultKind(parameter.value))
        return SetParametersResult(successful=True)

    def _publish(self, positions: Array) -> None:
        if self._true_joints.get_subscription_count() == 0:
            return
        message = JointState()
        message.header.stamp = self.get_clock().now().to_msg()
        message.name = list(self._names)
        message.position = positions.tolist()
        message.velocity = message.effort = [0.0] * len(self._names)
        self._true_joints.publish(message)

    def _on_reset(self, request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        self._thread.do(lambda: self._board.reset(ResetCause.WATCHDOG))
        response.success, response.message = True, 'the board starts again'
        return response

    def _on_plug(self, request: SetBool.Request, response: SetBool.Response) -> SetBool.Response:
        try:
            line = FakeLine(self._path) if request.data else None
        except LinkError as error:
            response.success, response.message = False, str(error)
            return response
        self._thread.do(lambda: self._thread.plug(line))
        response.success, response.message = True, 'plugged in' if line else 'unplugged'
        return response

    def _on_mute(self, request: SetBool.Request, response: SetBool.Response) -> SetBool.Response:
        self._thread.is_mute = request.data
        response.success, response.message = True, 'mute' if request.data else 'talks again'
        return response

    def _on_stop_pin(
        self, request: SetBool.Request, response: SetBool.Response
    ) -> SetBool.Response:
        self._board.is_stop_open = request.data
        response.success = True
        response.message = 'the stop contact is open' if request.data else 'closed'
        return response
