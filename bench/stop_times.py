"""Seconds until the servo targets stop after a process dies or freezes, and after a STOP."""

import os
import random
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
from std_msgs.msg import Bool

from bench.row import Row
from bridge.protocol import Stop
from hexarm import keep_to_this_computer
from manipulator.nodes.qos import EVERY_WORD
from rig import Rig

RUNS, STOPS = 5, 20
GOAL, STOP_GOAL_MS = 0.5, 50.0
SPACE = 'stop_times'
SIGNALS = {'killed': signal.SIGKILL, 'frozen': signal.SIGSTOP}


def rows():
    os.environ['ROS_DOMAIN_ID'] = str(1 + os.getpid() % 100)
    keep_to_this_computer()
    return [*rows_of('one process', is_separate=False), *rows_of('separate', is_separate=True)]


def rows_of(what, is_separate):
    with (
        tempfile.TemporaryDirectory() as folder,
        Rig(Path(folder), SPACE, is_separate=is_separate) as rig,
    ):
        rig.enable()
        times = {
            (name, how): [stop_time(rig, name, how) for _ in range(RUNS)]
            for name in rig.names
            for how in SIGNALS
        }
        cable = [cable_time(rig) for _ in range(RUNS)]
        stops = emergency_stops(rig)
        commands = [command_time(rig) for _ in range(STOPS)]
    p50, worst = 1e3 * np.median(stops), 1e3 * np.max(stops)
    load = os.getloadavg()[0] / (os.cpu_count() or 1)
    return [
        *(row(f'{what}: {name} {how}', values) for (name, how), values in times.items()),
        row(f'{what}: cable pulled', cable),
        Row(
            f'{what}: emergency_stop published to STOP frame, median, worst of {STOPS}',
            f'{p50:.1f}, {worst:.1f} ms',
            f'median ≤ {STOP_GOAL_MS:g} ms',
            p50 <= STOP_GOAL_MS,
        ),
        Row(
            f'{what}: `hexarm stop`, from its start to the STOP frame, median, worst of {STOPS}',
            f'{np.median(commands):.3f}, {np.max(commands):.3f} s, {load:.1f} processes a core',
            f'≤ {GOAL:g} s',
            max(commands) <= GOAL,
        ),
    ]


def row(what, times):
    value = f'{np.median(times):.3f}, {np.max(times):.3f} s'
    name = f'{what}: servo targets still, median, worst of {len(times)}'
    return Row(name, value, f'≤ {GOAL:g} s', max(times) <= GOAL)


def stop_time(rig, name, how):
    rig.circle(random.uniform(0.5, 1.0))
    seconds = rig.stop_time(name, SIGNALS[how])
    revive(rig, name, how)
    return seconds


def revive(rig, name, how):
    """The process again, and the machine as ready for goals as it was."""
    if how == 'killed':
        rig.start(name)
    else:
        rig.send(name, signal.SIGCONT)
    rig.user.spin(1.0)
    rig.enable()
    rig.user.wait('goals', lambda: rig.user.motion('mode') == 'hold', 10.0)


def cable_time(rig):
    rig.circle(random.uniform(0.5, 1.0))
    pulled = rig.pull()
    seconds = rig.recorder.standstill(pulled, 1.0) - pulled
    rig.plug()
    rig.user.spin(1.0)
    rig.enable()
    return seconds


def command_time(rig):
    rig.user.spin(random.uniform(0.1, 0.3))
    before = time.monotonic()
    subprocess.run(
        [sys.executable, '-m', 'hexarm', 'stop', SPACE], capture_output=True, check=True
    )
    seconds = rig.tap.frames(Stop, before)[0][0] - before
    clear(rig)
    return seconds


def clear(rig):
    rig.user.wait('stopped', lambda: rig.user.machine_state.message == 'stopped', 5.0)
    rig.user.trigger('serial_bridge/clear_fault')
    rig.user.wait('goals', lambda: rig.user.motion('mode') == 'hold', 10.0)


def emergency_stops(rig):
    publisher = rig.user.node.create_publisher(Bool, 'emergency_stop', EVERY_WORD)
    rig.user.wait('the bridge', lambda: publisher.get_subscription_count() == 1, 10.0)
    times = []
    for _ in range(STOPS):
        rig.circle(random.uniform(0.1, 0.3))
        before = time.monotonic()
        publisher.publish(Bool(data=True))
        rig.user.wait('STOP', lambda t=before: rig.tap.frames(Stop, t), 5.0)
        times.append(rig.tap.frames(Stop, before)[0][0] - before)
        clear(rig)
    return times
