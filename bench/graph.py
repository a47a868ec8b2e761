"""The running machine: `hexarm up` with its nodes in one process, and in separate processes."""

import json
import os
import subprocess
import sys
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from bench.row import Row
from hexarm import keep_to_this_computer
from hexarm.client import Client

SPACE = 'bench'
SECONDS = 8.0
MEMORY_MB, CPU_RATIO, LATENCY_RATIO, START_RATIO = 200.0, 0.75, 0.85, 0.5
CORE_SHARE, BARE_RATIO = 18.0, 1.2
PAGE = os.sysconf('SC_PAGE_SIZE')
TICKS = os.sysconf('SC_CLK_TCK')


@dataclass(frozen=True)
class Run:
    """One `hexarm up`: seconds to enabled; MB resident; % of a core; the bridge's values."""

    start: float
    memory: float
    share: float
    values: dict[str, str]

    @property
    def latency(self):
        return float(self.values['setpoint_to_frame_p50_ms'])


def rows():
    os.environ['ROS_DOMAIN_ID'] = str(1 + os.getpid() % 100)
    keep_to_this_computer()
    bare = float(np.median(bare_chain())) * 1e3
    separate, together = running('--separate'), running()
    return [
        Row('bare rclpy chain of three processes, p50', f'{bare:.2f} ms'),
        *described('one process', together),
        *described('separate processes', separate),
        Row('of one core, during a cycle at 100 Hz, one process', f'{together.share:.0f} %',
            f'≤ {CORE_SHARE:g} %', together.share <= CORE_SHARE),
        ratio('setpoint to frame p50, one process / bare chain', together.latency / bare,
              BARE_RATIO),
        ratio('CPU during a cycle, one process / separate', together.share / separate.share,
              CPU_RATIO),
        ratio('setpoint to frame p50, one process / separate',
              together.latency / separate.latency, LATENCY_RATIO),
        ratio('hexarm up to enabled, one process / separate',
              together.start / separate.start, START_RATIO),
        Row('memory of the whole graph, one process', f'{together.memory:.0f} MB',
            f'≤ {MEMORY_MB:g} MB', together.memory <= MEMORY_MB),
    ]  # fmt: skip


def ratio(what, value, most):
    return Row(what, f'{value:.2f}', f'≤ {most:g}', value <= most)


def described(name, run):
    v = run.values
    return [
        Row(f'{name}: hexarm up to enabled', f'{run.start:.1f} s'),
        Row(f'{name}: resident memory, fake board and hexarm up included', f'{run.memory:.0f} MB'),
        Row(f'{name}: of one core, during a cycle at 100 Hz', f'{run.share:.0f} %'),
        Row(f'{name}: setpoint published to frame written, p50, p99',
            f'{v["setpoint_to_frame_p50_ms"]}, {v["setpoint_to_frame_p99_ms"]} ms'),
        Row(f'{name}: round trip to the board, p50', f'{v["round_trip_p50_ms"]} ms'),
    ]  # fmt: skip


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


def running(*words):
    """A machine brought up, and what it takes while it plays its cycle."""
    command = [sys.executable, '-m', 'hexarm', 'up', 'robocake', '--namespace', SPACE, *words]
    begun = time.monotonic()
    up = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    try:
        while 'is up' not in (line := up.stdout.readline()):
            if not line:
                raise RuntimeError(f'{" ".join(command)} ended')
        start = time.monotonic() - begun
        with Client(SPACE) as client:
            client.trigger('trajectory/start_cycle')
            client.spin(2.0)
            pids = [up.pid, *children(up.pid)]
            before, clock = sum(map(cpu_seconds, pids)), time.monotonic()
            client.spin(SECONDS)
            share = 100 * (sum(map(cpu_seconds, pids)) - before) / (time.monotonic() - clock)
            bridge = client.diagnostics[f'{SPACE}/serial_bridge']
            values = {pair.key: pair.value for pair in bridge.values}
            return Run(start, sum(map(resident, pids)) / 1e6, share, values)
    finally:
        up.terminate()
        up.communicate()


def children(pid):
    """The processes that a process has started."""
    text = Path(f'/proc/{pid}/task/{pid}/children').read_text()
    return [found for child in map(int, text.split()) for found in (child, *children(child))]


def resident(pid):
    """Bytes in memory."""
    return int(Path(f'/proc/{pid}/statm').read_text().split()[1]) * PAGE


def cpu_seconds(pid):
    """Of all threads of a process, user and system."""
    fields = Path(f'/proc/{pid}/stat').read_text().rpartition(')')[2].split()
    return (int(fields[11]) + int(fields[12])) / TICKS
