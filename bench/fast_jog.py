"""The arm jogged at 500 setpoints a second through the whole graph: message rates and jitter."""

import os
import tempfile
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
from geometry_msgs.msg import PoseStamped, TwistStamped
from sensor_msgs.msg import JointState

from bench.graph import cpu_seconds
from bench.row import Row
from bridge.frames import encode
from bridge.protocol import Setpoint
from hexarm import keep_to_this_computer
from hexarm.client import Client
from hexarm.graph import Graph, machine_graph
from hexarm.machines import read
from manipulator.nodes.messages import seconds
from manipulator.nodes.qos import COMMAND

MACHINE, RATE, SECONDS, PERIOD = 'arm_6r_stepper', 500.0, 6.0, 0.02
NAME, MOST_SHARE = 'jogging at 500 Hz', 60.0
BITS_PER_BYTE = 10  # with start and stop bit


def rows():
    os.environ['ROS_DOMAIN_ID'] = str(1 + os.getpid() % 100)
    keep_to_this_computer()
    line = line_load(RATE)
    return [
        *rows_of('one process', jogged('machine'), MOST_SHARE),
        *rows_of('separate processes', jogged('trajectory')),
        Row(f'{NAME}: load of the line', f'{line:.0f} %', '≤ 80', line <= 80),
    ]


def rows_of(what, measured, most_share=np.inf):
    setpoints, commands, jitter, shares = measured
    whole, name = sum(shares.values()), f'{NAME}, {what}'
    parts = ', '.join(f'{part} {share:.0f} %' for part, share in shares.items())
    goal = f'≤ {most_share:g} %' if np.isfinite(most_share) else ''
    return [
        Row(f'{name}: setpoints, joint commands a second', f'{setpoints:.0f}, {commands:.0f}'),
        Row(f'{name}: jitter of the tick, p50, p99', '{:.2f}, {:.2f} ms'.format(*jitter)),
        Row(f'{name}: of one core', f'{whole:.0f} %: {parts}', goal, whole <= most_share),
    ]


def line_load(commands):
    """Per cent of the wire's bytes that so many setpoints a second take."""
    file = read(MACHINE)
    size = len(encode(Setpoint(200, (12345,) * len(file.servos['joints'])), 12345))
    return 100 * commands * size * BITS_PER_BYTE / file.link['baud']


def jogged(owner):
    """Setpoints and commands a second by their stamps, the tick's jitter (ms), CPU by process.

    `owner` is the process with the trajectory node: 'machine', or 'trajectory' in separate ones.
    """
    with tempfile.TemporaryDirectory() as folder:
        nodes = [
            replace(node, parameters=node.parameters | {'rate': str(RATE)})
            if node.name == owner
            else node
            for node in machine_graph(
                MACHINE, 'fake', Path(folder) / 'board', is_separate=owner == 'trajectory'
            )
        ]
        with Graph(nodes, 'fast') as running, Client('fast') as client:
            client.enable()
            twists = client.node.create_publisher(TwistStamped, 'cmd_vel/joy', COMMAND)
            client.wait('a listener', lambda: twists.get_subscription_count() > 0, 10.0)
            drive(client, twists, 1.0)
            heard = {PoseStamped: [], JointState: []}
            for kind, topic in ((PoseStamped, 'setpoint'), (JointState, 'joint_command')):
                client.node.create_subscription(kind, topic, heard[kind].append, 100)
            pids = running.pids()
            before = {name: cpu_seconds(pid) for name, pid in pids.items()}
            taken = drive(client, twists, SECONDS)
            shares = {n: 100 * (cpu_seconds(pid) - before[n]) / taken for n, pid in pids.items()}
            client.spin(1.0)
            told = {v.key: v.value for v in client.diagnostics['fast/trajectory'].values}
            jitter = [float(told[f'tick_jitter_{p}_ms']) for p in ('p50', 'p99')]
            setpoints, commands = (rate(heard[kind]) for kind in (PoseStamped, JointState))
            return setpoints, commands, jitter, shares


def rate(messages):
    stamps = [seconds(message.header.stamp) for message in messages]
    return len(np.unique(stamps)) / (stamps[-1] - stamps[0])


def drive(client, twists, duration):
    """To and fro, so that the arm stays inside its range; returns how long it took."""
    begin = time.monotonic()
    while time.monotonic() < begin + duration:
        message = TwistStamped()
        message.header.stamp = client.node.get_clock().now().to_msg()
        message.twist.linear.x = 0.1 * float(np.cos(2 * np.pi * (time.monotonic() - begin) / 2.0))
        twists.publish(message)
        client.spin(PERIOD)
    return time.monotonic() - begin
