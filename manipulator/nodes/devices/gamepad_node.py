"""A gamepad's Joy messages, for machines without the `joy` package."""

import os
from typing import cast

import evdev
from rclpy.node import Node
from sensor_msgs.msg import Joy

from manipulator.errors import LinkError
from manipulator.nodes.devices.evdev_pad import Device, EvdevPad, find_pad, input_devices
from manipulator.nodes.diagnostics import ERROR, OK, Diagnostics, Report
from manipulator.nodes.parameters import declare
from manipulator.nodes.qos import MEASUREMENT
from manipulator.nodes.steady_timer import SteadyTimer

DEVICE = 'path of the pad (/dev/input/event*, /dev/input/by-id/*); empty: the first one found'
LOOK_AGAIN = 1.0
"""Seconds between two searches for a pad."""


class Gamepad(Node):
    """Joy out, all the time while there is a pad; see docs/joystick.md."""

    def __init__(self) -> None:
        super().__init__('gamepad')
        only = declare(self, 'device', '', DEVICE)
        self._only = os.path.realpath(only) if only else ''
        topic = declare(self, 'topic', 'joy', 'where the Joy messages go')
        rate = declare(self, 'rate', 100.0, 'messages per second (Hz)', (20.0, 500.0))
        self._pad: EvdevPad | None = None
        self._problem = ''
        self._publisher = self.create_publisher(Joy, topic, MEASUREMENT)
        self._look()
        self._timer = SteadyTimer(self, 1.0 / rate, self._tick)
        self._search = SteadyTimer(self, LOOK_AGAIN, self._look)
        self._diagnostics = Diagnostics(self, self._report, (topic,))

    def close(self) -> None:
        """Gives the pad back."""
        if self._pad is not None:
            self._pad.close()

    def _look(self) -> None:
        if self._pad is not None:
            return
        try:
            self._pad = find_pad(input_devices(), _open, self._only)
        except LinkError as error:
            self._say(str(error))
            return
        self._problem = ''
        self.get_logger().info(f'{self._pad.name} at {self._pad.path}')

    def _tick(self) -> None:
        if self._pad is None:
            return
        try:
            axes, buttons = self._pad.update().joy
        except LinkError as error:
            self._say(str(error))
            self._pad.close()
            self._pad = None
            return
        message = Joy(axes=axes, buttons=buttons)
        message.header.stamp = self.get_clock().now().to_msg()
        self._publisher.publish(message)

    def _say(self, problem: str) -> None:
        if problem != self._problem:
            self._problem = problem
            self.get_logger().warning(problem)

    def _report(self) -> Report:
        if self._pad is None:
            return ERROR, self._problem, {}
        has_heartbeat = self._pad.has_heartbeat
        return OK, self._pad.name, {'device': self._pad.path, 'has_heartbeat': has_heartbeat}


def _open(path: str) -> Device:
    return cast(Device, evdev.InputDevice(path, readonly=True))
