"""The running graph: what a setpoint's way to the line takes, and what all processes cost."""

import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

from bench.row import Row
from hexarm.client import Client
from hexarm.graph import Graph, machine_graph

SECONDS = 8.0
CORE_SHARE, LATENCY_MS = 60.0, 2.0


def rows():
    os.environ['ROS_DOMAIN_ID'] = str(1 + os.getpid() % 100)
    os.environ['ROS_AUTOMATIC_DISCOVERY_RANGE'] = 'LOCALHOST'
    bare_p50, bare_p99 = np.percentile(bare_chain(), [50, 99]) * 1e3
    values, share = graph()
    p50, p99 = (float(values[f'setpoint_to_frame_{p}_ms']) for p in ('p50', 'p99'))
    return [
        Row('bare rclpy chain of three processes, p50, p99', f'{bare_p50:.2f}, {bare_p99:.2f} ms'),
        Row(
            'setpoint published to frame written, p50, p99',
            f'{p50:.2f}, {p99:.2f} ms',
            f'p50 ≤ {LATENCY_MS:g} ms',
            p50 <= LATENCY_MS,
        ),
        Row('the same by the bare chain, p50', f'{p50 / bare_p50:.2f}×'),
        Row('round trip to the board, p50', f'{float(values["round_trip_p50_ms"]):.2f} ms'),
        Row(
            'five processes at 100 Hz, of one core',
            f'{share:.0f} %',
            f'≤ {CORE_SHARE:g} %',
            share <= CORE_SHARE,
        ),
    ]


def bare_chain():
    """One-way times (s) of a chain that does nothing but pass messages on."""
    roles = {
        role: subprocess.Popen(
            [sys.executable, '-m', 'bench.relay_chain', role], stdout=subprocess.PIPE, text=True
        )
        for role in ('sink', 'relay', 'source')
    }
    try:
        output, _ = roles['sink'].communicate(timeout=60)
    finally:
        for process in roles.values():
            process.kill()
            process.communicate()
    return json.loads(output)


def graph():
    """The bridge's diagnostics and the share of one core (%) while the platform stands enabled."""
    with tempfile.TemporaryDirectory() as folder:
        nodes = machine_graph('robocake', 'fake', Path(folder) / 'board', is_separate=True)
        with Graph(nodes, 'bench') as running, Client('bench') as client:
            client.enable()
            client.spin(1.0)
            pids = running.pids().values()
            before = sum(map(cpu_seconds, pids))
            client.spin(SECONDS)
            share = 100 * (sum(map(cpu_seconds, pids)) - before) / SECONDS
            bridge = client.diagnostics['bench/serial_bridge']
            return {pair.key: pair.value for pair in bridge.values}, share


def cpu_seconds(pid):
    """Of all threads of a process, user and system."""
    fields = Path(f'/proc/{pid}/stat').read_text().rpartition(')')[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf('SC_CLK_TCK')
