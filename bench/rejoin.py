"""A process killed and restarted: seconds until messages arrive in both directions.

`python -m bench.rejoin` is the process that is killed: it sends back what it hears.
"""

import os
import subprocess
import sys
import time

import numpy as np
import rclpy
from rclpy.experimental import EventsExecutor
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions
from std_msgs.msg import Float64

from bench.row import Row
from hexarm import keep_to_this_computer
from manipulator.nodes.qos import MEASUREMENT

KILLS = 12
AT_MOST = 25.0
"""Seconds to wait: longer than a dead process is remembered."""

PERIOD = 0.01


def rows():
    os.environ['ROS_DOMAIN_ID'] = str(1 + os.getpid() % 100)
    keep_to_this_computer()
    rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
    try:
        seconds = Caller().seconds_after_kills()
    finally:
        rclpy.try_shutdown()
    median, longest = np.median(seconds), np.max(seconds)
    yield Row('median, longest', f'{median:.2f}, {longest:.2f} s', '≤ 5 s', longest <= 5.0)


class Caller:
    """Says the time over and over, and waits for it to come back."""

    def __init__(self):
        self._node = Node('caller')
        self._executor = EventsExecutor()
        self._executor.add_node(self._node)
        self._heard = 0.0
        calls = self._node.create_publisher(Float64, 'call', MEASUREMENT)
        self._node.create_subscription(Float64, 'echo', self._on_echo, MEASUREMENT)
        self._node.create_timer(PERIOD, lambda: calls.publish(Float64(data=time.monotonic())))

    def seconds_after_kills(self):
        """From the start of each new process's node to the first echo of what it was sent."""
        self._seconds()
        times = [self._seconds() for _ in range(KILLS)]
        self._executor.shutdown()
        self._node.destroy_node()
        return times

    def _seconds(self):
        command = [sys.executable, '-m', 'bench.rejoin']
        with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
            started = float(process.stdout.readline())
            self._heard = 0.0
            while self._heard < started and time.monotonic() < started + AT_MOST:
                self._executor.spin_once(timeout_sec=PERIOD)
            taken = time.monotonic() - started
            process.kill()
        return taken

    def _on_echo(self, message):
        self._heard = message.data


def echo():
    rclpy.init()
    node = Node('echo')
    echoes = node.create_publisher(Float64, 'echo', MEASUREMENT)
    node.create_subscription(Float64, 'call', echoes.publish, MEASUREMENT)
    print(time.monotonic(), flush=True)
    rclpy.spin(node)


if __name__ == '__main__':
    echo()
