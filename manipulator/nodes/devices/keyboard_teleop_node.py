"""From the keys of a terminal to twists, jog modes, gripper, home, stop and saved poses."""

import signal
import time

from rclpy.node import Node

from manipulator.nodes.devices.jog_topics import JogTopics
from manipulator.nodes.devices.terminal import Terminal
from manipulator.nodes.diagnostics import OK, Diagnostics, Report
from manipulator.nodes.graph_check import SubscriberCheck, place
from manipulator.nodes.parameters import declare
from manipulator.nodes.steady_timer import SteadyTimer
from manipulator.teleop.keyboard import HELP, Keyboard, keys_of

LOOK_AROUND = 0.5
"""Seconds between two subscriber checks."""

GRIPPER = 'part of its range that the gripper moves in 1 s'


class KeyboardTeleop(Node):
    """Keys in; cmd_vel/keyboard, jog_mode, gripper out; see docs/joystick.md."""

    def __init__(self, terminal: Terminal) -> None:
        super().__init__('keyboard_teleop')
        rate = declare(self, 'rate', 50.0, 'twists per second (Hz)', (20.0, 500.0))
        linear = declare(self, 'linear_speed', 0.02, 'speed at the start (m/s)', (1e-4, 1.0))
        angular = declare(self, 'angular_speed', 0.2, 'speed at the start (rad/s)', (1e-3, 5.0))
        self._gripper_step = declare(self, 'gripper_speed', 0.5, GRIPPER, (0.05, 5.0)) / rate
        self._terminal = terminal
        self._keyboard = Keyboard(linear, angular)
        self._topics = JogTopics(self, 'keyboard')
        self._subscriber_check = SubscriberCheck(place(self), time.monotonic())
        self._timer = SteadyTimer(self, 1.0 / rate, self._tick)
        self._diagnostics = Diagnostics(self, self._report, ('cmd_vel/keyboard',))
        terminal.show(f'{HELP}\n')
        self._show()
        self._looking = SteadyTimer(self, LOOK_AROUND, self._look_around)

    def close(self) -> None:
        """Releases the machine and the terminal."""
        self._topics.close()
        self._terminal.show('\n')
        self._terminal.restore()

    def _tick(self) -> None:
        characters = self._terminal.read()
        now, before = time.monotonic(), self._keyboard
        for key in keys_of(characters or b''):
            self._keyboard = self._keyboard.press(key, now)
        after = self._keyboard
        self._topics.drive(after.twist(now), after.frame, after.is_held(now))
        self._topics.grip(after.grip(now) * self._gripper_step)
        if after.stops != before.stops:
            self._topics.stop()
        if after.homes != before.homes:
            self._topics.go_home()
        if after.saves != before.saves:
            self._topics.save_pose()
        if after.mode != before.mode:
            self._topics.choose(after.mode)
        if after.line != before.line:
            self._show()
        if after.is_over or characters is None:
            signal.raise_signal(signal.SIGINT)

    def _look_around(self) -> None:
        news = self._subscriber_check.update(self._topics.has_subscribers, time.monotonic())
        if news:
            self._terminal.show(f'\r\x1b[K {news}\n')
            self._show()

    def _show(self) -> None:
        self._terminal.show(f'\r\x1b[K {self._keyboard.line}')

    def _report(self) -> Report:
        is_held = self._keyboard.is_held(time.monotonic())
        values = {'mode': self._keyboard.mode, 'frame': self._keyboard.frame}
        return OK, 'a key is held' if is_held else 'no key', values
