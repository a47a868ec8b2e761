"""Both machines as real processes moved through faults for ten minutes: `python -m bench.soak`.

What the faults must not do, test/world/test_soak.py tries in simulated time; here no process ends
or grows, and the link is there again at the board's first word. Status 1 where that is not so.
"""

import argparse
import contextlib
import itertools
import os
import sys
import tempfile
import time
from pathlib import Path
from random import Random

import numpy as np
from std_msgs.msg import Bool, Float64
from std_srvs.srv import SetBool

from bridge.fake.faults import Faults
from bridge.protocol import Arm, Disarm, ResetCause, Setpoint
from hexarm import keep_to_this_computer, machines
from manipulator.errors import ManipulatorError
from manipulator.nodes.qos import COMMAND, EVERY_WORD
from manipulator.pose import Pose
from rig import Rig

FAULTS_PER_MINUTE = 150.0
BOOT = 2.0
MACHINES = {'hexapod': ('robocake', 0.004), 'arm': ('arm_6r', 0.03)}
"""Machine file, and how far from home it is moved along each axis (m)."""
WARMING, WARMING_UP, LEVEL = 150.0, 20.0, 1.5
"""Until all kinds of motion were driven (s) a process may take 20 MB more; later 1.5 MB."""
DEADLINE, PERIOD = 0.2, 0.02
AGAIN_WITHIN = 3.0
"""Seconds from a board's boot to its bridge."""


class Soak:
    """A user who re-arms whatever the faults have stopped, and goes on moving."""

    def __init__(self, rig, machine, reach, seed):
        self.rig, self.user, self.reach = rig, rig.user, reach
        self.random = Random(seed)
        self.home = machines.load(machine).kinematics.home
        node = self.user.node
        self.stops = node.create_publisher(Bool, 'emergency_stop', EVERY_WORD)
        self.overrides = node.create_publisher(Float64, 'speed_override', COMMAND)
        self.moves = self.enablings = 0
        self.is_calm = False

    def go_on(self, seconds):
        """The memory which each process had least of in the second half (MB): what it keeps.

        The arrays of a plan, tens of megabytes now and then, come and go.
        """
        begin, least = time.monotonic(), np.inf
        while time.monotonic() < begin + seconds:
            with contextlib.suppress(ManipulatorError):
                self.act()
            self.user.spin(0.1)
            if self.rig.dead():
                raise SystemExit(f'a process ended: {self.rig.dead()}')
            if time.monotonic() > begin + seconds / 2:
                least = np.minimum(least, memory(self.rig))
        return least

    def act(self):
        state = self.user.machine_state.message
        if state in ('stopped', 'fault'):
            self.user.trigger('serial_bridge/clear_fault')
        elif state in ('disarmed', 'unclaimed'):
            self.enablings += 1
            self.user._call(SetBool, 'serial_bridge/enable', SetBool.Request(data=True))
        elif self.user.motion('mode') not in ('', 'disabled'):
            self.move()

    def move(self):
        choice = self.random.random()
        if choice < 0.8:
            offset = [self.random.uniform(-self.reach, self.reach) for _ in range(3)]
            self.user.publish_goal(Pose(self.home.position + offset, self.home.rotation))
            self.moves += 1
        elif choice < 0.85:
            self.overrides.publish(Float64(data=self.random.choice([0.3, 1.0])))
        elif choice < 0.9:
            self.user.trigger('trajectory/start_cycle')
        elif choice < 0.95:
            self.user.trigger('trajectory/stop')
        elif not self.is_calm:
            self.stops.publish(Bool(data=True))


def resident(pid):
    """Memory of a process in megabytes."""
    pages = int(Path(f'/proc/{pid}/statm').read_text().split()[1])
    return pages * os.sysconf('SC_PAGE_SIZE') / 1e6


def memory(rig):
    return np.array([resident(rig.pid(name)) for name in rig.names])


def bad_frames(rig):
    """How many frames are out of range, or far from the one before."""
    ranges = np.array(rig.calibration.count_ranges)
    speeds = np.array(rig.calibration.count_speeds)
    frames = rig.tap.frames((Setpoint, Arm, Disarm))
    setpoints = [(t, np.array(m.counts)) for t, m in frames if isinstance(m, Setpoint)]
    bad = sum(bool((c < ranges[:, 0]).any() or (c > ranges[:, 1]).any()) for _, c in setpoints)
    for (before, a), (now, b) in itertools.pairwise(setpoints):
        # The bridge's clock and ours, on a busy computer, differ by two periods at most.
        is_far = (np.abs(b - a) > speeds * (now - before + 3 * PERIOD) + 1).any()
        bad += bool(now - before < DEADLINE / 2 and is_far)
    for (before, old), (now, new) in itertools.pairwise(rig.recorder.changes()):
        if None not in (*old, *new):
            way = np.abs(np.subtract(new, old))
            bad += bool((way > speeds * (now - before + 3 * PERIOD) + 1).any())
    return bad


def reconnections(rig, count):
    """Seconds from the end of each of the board's boots until the bridge has it again."""
    times = []
    for _ in range(count):
        rig.board.do(lambda: rig.recorder.board.reset(ResetCause.WATCHDOG))
        begun = time.monotonic()
        rig.user.spin(1.0)
        rig.user.wait('disarmed', lambda: rig.user.machine_state.message == 'disarmed', 10.0)
        times.append(time.monotonic() - begun - BOOT)
    return times


def soaked(kind, seconds, folder):
    """Drives one machine through faults; whether all was as it should be."""
    machine, reach = MACHINES[kind]
    faults = Faults(seed=1, per_minute=FAULTS_PER_MINUTE)
    with Rig(folder, f'soak_{kind}', machine, BOOT, faults) as rig:
        soak = Soak(rig, machine, reach, seed=2)
        soak.user.wait('motion', lambda: soak.user.motion('mode') != '', 15.0)
        taken = [soak.go_on(seconds / 3) for _ in range(3)]
        faults.calm()
        soak.is_calm = True
        soak.overrides.publish(Float64(data=1.0))
        rig.user.wait('calm', lambda: not faults.active, 10.0)
        soak.go_on(4.0)
        rig.user.go_to(soak.home)
        times = reconnections(rig, 2)
        bad = bad_frames(rig)
    told = f'{faults.counts.total()} faults, {soak.moves} goals, {soak.enablings} enablings'
    print(f'{kind}: {told}; {bad} bad frames; again after boot: {np.round(times, 2)} s')
    grown = np.diff(taken, axis=0)
    for name, *more in zip(rig.names, *grown, strict=True):
        print(f'  {name}: {more[0]:+.2f}, {more[1]:+.2f} MB in the second and the last third')
    most = LEVEL if 2 / 3 * seconds > WARMING else WARMING_UP
    is_level = grown.sum(axis=0).max() < WARMING_UP and grown[1].max() < most
    return not bad and is_level and max(times) < AGAIN_WITHIN


def main(arguments):
    parser = argparse.ArgumentParser(prog='python -m bench.soak', description=__doc__)
    parser.add_argument('--seconds', type=float, default=600.0, help='of both machines together')
    seconds = parser.parse_args(arguments).seconds / len(MACHINES)
    os.environ['ROS_DOMAIN_ID'] = str(1 + os.getpid() % 100)
    keep_to_this_computer()
    results = []
    for kind in MACHINES:
        with tempfile.TemporaryDirectory() as folder:
            results.append(soaked(kind, seconds, Path(folder)))
    return 0 if all(results) else 1


if __name__ == '__main__':
    sys.exit(main(sys.argv[1:]))
