"""From a gamepad's Joy messages to twists, jog modes, gripper, home, stop and saved poses."""

import time
from collections.abc import Callable

from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import Joy

from manipulator.errors import InvalidInput
from manipulator.nodes.devices.jog_topics import JogTopics
from manipulator.nodes.diagnostics import ERROR, OK, WARN, Diagnostics, Report
from manipulator.nodes.parameters import declare
from manipulator.nodes.steady_timer import SteadyTimer
from manipulator.nodes.subscriptions import FilteredCallback, SoleSubscription
from manipulator.teleop.gamepad import Gamepad
from manipulator.teleop.joy_reader import JoyReader

GAMEPAD = 'mapping of the gamepad: a shipped name (xbox, playstation) or a path'
SCALE = 'full stick in parts of the speeds (m/s, rad/s) that the mapping states'
GRIPPER = 'part of its range that the gripper moves in 1 s'


class JoyTeleop(Node):
    """Joy in; cmd_vel/joy, jog_mode, gripper out; see docs/joystick.md."""

    def __init__(self, load: Callable[[str], Gamepad]) -> None:
        super().__init__('joy_teleop')
        gamepad = load(declare(self, 'gamepad', 'xbox', GAMEPAD))
        topic = declare(self, 'topic', 'joy', 'where the Joy messages come from')
        rate = declare(self, 'rate', 50.0, 'twists per second (Hz)', (20.0, 500.0))
        self._scale = declare(self, 'scale', 1.0, SCALE, (0.01, 10.0))
        self._gripper_step = declare(self, 'gripper_speed', 0.5, GRIPPER, (0.05, 5.0)) / rate
        self._reader = JoyReader(gamepad)
        self._stops = self._saves = 0
        self._joy = FilteredCallback(self, 'joy', self._on_joy)
        self._topics = JogTopics(self, 'joy')
        self._pad = SoleSubscription(
            self, Joy, topic, self._joy, qos_profile_sensor_data, is_continuous=True
        )
        self._timer = SteadyTimer(self, 1.0 / rate, self._tick)
        self._diagnostics = Diagnostics(self, self._report, ('cmd_vel/joy', topic))

    def close(self) -> None:
        """Releases the machine."""
        self._topics.close()

    def _on_joy(self, message: Joy) -> None:
        axes, buttons = message.axes.tolist(), message.buttons.tolist()
        self._reader = self._reader.receive(axes, buttons, time.monotonic(), self._pad.conflict)
        if self._reader.fault:
            raise InvalidInput(self._reader.fault)

    def _tick(self) -> None:
        command = self._reader.command(time.monotonic())
        self._topics.choose(command.mode)
        self._topics.drive(command.twist * self._scale, command.frame, command.is_held)
        self._topics.home(command.is_homing)
        if command.stops != self._stops:
            self._stops = command.stops
            self._topics.stop()
        if command.saves != self._saves:
            self._saves = command.saves
            self._topics.save_pose()
        if command.grip:
            self._topics.grip(command.grip * self._gripper_step)

    def _report(self) -> Report:
        command = self._reader.command(time.monotonic())
        values = {
            'mode': command.mode,
            'frame': command.frame,
            'last_joy_age_s': self._joy.age,
            'joy_refused': self._joy.refused,
            'last_refusal': self._joy.last_refusal,
            'not_seen_at_rest_yet': ', '.join(self._reader.untrusted),
        }
        conflict = self._pad.conflict
        if conflict:
            return ERROR, f'{conflict}: end all but one, then release the deadman', values
        if command.reason:
            return WARN, f'{self._pad.topic}: {command.reason}', values
        return OK, 'deadman held' if command.is_held else 'deadman released', values
