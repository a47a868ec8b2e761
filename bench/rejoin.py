"""A process killed and started again: seconds until it hears the others and they hear it.

`python -m bench.rejoin fresh|lowest` is the process that is killed: it sends back what it hears,
from an address as manipulator/nodes/discovery.py gives it, or as Fast DDS does by itself.
"""

import contextlib
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

import hexarm  # noqa: F401 (it says how often processes announce themselves)
from bench.row import Row
from manipulator.nodes.discovery import fresh_address
from manipulator.nodes.qos import MEASUREMENT

KILLS = 12
AT_MOST = 25.0
"""Seconds to wait: longer than a dead process is remembered."""

PERIOD = 0.01
ADDRESSES = {'lowest': contextlib.nullcontext, 'fresh': fresh_address}


def rows():
    os.environ['ROS_DOMAIN_ID'] = str(1 + os.getpid() % 100)
    os.environ['ROS_AUTOMATIC_DISCOVERY_RANGE'] = 'LOCALHOST'
    rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
    try:
        seconds = {kind: Caller(kind).seconds_after_kills() for kind in ADDRESSES}
    finally:
        rclpy.try_shutdown()
    for kind, words in (('lowest', 'at the lowest address'), ('fresh', 'at one not used lately')):
        median, longest = np.median(seconds[kind]), np.max(seconds[kind])
        yield Row(f'{words}: median, longest', f'{median:.2f}, {longest:.2f} s')
    ratio = np.mean(seconds['lowest']) / np.mean(seconds['fresh'])
    yield Row('mean time, the first over the second', f'{ratio:.1f}×')


class Caller:
    """Says the time over and over, and waits for it to come back."""

    def __init__(self, kind):
        self._kind = kind
        self._node = Node(f'caller_{kind}')
        self._executor = EventsExecutor()
        self._executor.add_node(self._node)
        self._heard = 0.0
        calls = self._node.create_publisher(Float64, f'call_{kind}', MEASUREMENT)
        self._node.create_subscription(Float64, f'echo_{kind}', self._on_echo, MEASUREMENT)
        self._node.create_timer(PERIOD, lambda: calls.publish(Float64(data=time.monotonic())))

    def seconds_after_kills(self):
        """From the start of each new process's node to the first echo of what it was sent."""
        self._seconds()
        times = [self._seconds() for _ in range(KILLS)]
        self._executor.shutdown()
        self._node.destroy_node()
        return times

    def _seconds(self):
        command = [sys.executable, '-m', 'bench.rejoin', self._kind]
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


def echo(kind):
    rclpy.init()
    with ADDRESSES[kind]():
        node = Node(f'echo_{kind}')
    echoes = node.create_publisher(Float64, f'echo_{kind}', MEASUREMENT)
    node.create_subscription(Float64, f'call_{kind}', echoes.publish, MEASUREMENT)
    print(time.monotonic(), flush=True)
    rclpy.spin(node)


if __name__ == '__main__':
    echo(sys.argv[1])
