"""Both machines moved through hundreds of faults: most of a minute here, ten in `make soak`."""

import contextlib
import itertools
import os
import time
from pathlib import Path
from random import Random

import numpy as np
import pytest
from std_msgs.msg import Bool, Float64
from std_srvs.srv import SetBool

from bridge.faults import Faults
from bridge.messages import Arm, Disarm, ResetCause, Setpoint
from hexarm import machines
from hexarm.rig import Rig
from manipulator.errors import ManipulatorError
from manipulator.nodes.qos import COMMAND
from manipulator.pose import Pose

pytestmark = pytest.mark.graph

SECONDS = float(os.environ.get('SOAK_SECONDS', '50')) / 2
"""For each machine."""
FAULTS_PER_MINUTE = 150.0
BOOT = 2.0
MACHINES = {'hexapod': ('robocake', 0.004), 'arm': ('arm_6r', 0.03)}
"""Machine file, and how far from home it is moved along each axis (m)."""
WARMING, WARMING_UP, LEVEL = 150.0, 20.0, 1.5
"""Until all kinds of motion were driven (s) a process may take 20 MB more; later 1.5 MB."""
DEADLINE, PERIOD = 0.2, 0.02


class Soak:
    """A user who re-arms whatever the faults have stopped, and goes on moving."""

    def __init__(self, rig, machine, reach, seed):
        self.rig, self.user, self.reach = rig, rig.user, reach
        self.random = Random(seed)
        self.home = machines.load(machine).kinematics.home
        node = self.user.node
        self.stops = node.create_publisher(Bool, 'emergency_stop', COMMAND)
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
            assert not self.rig.dead()
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


def check_frames(rig):
    """Every frame in its range; each near the last one, or near where the servos are."""
    ranges = np.array(rig.calibration.count_ranges)
    speeds = np.array(rig.calibration.count_speeds)
    frames = rig.tap.heard((Setpoint, Arm, Disarm))
    setpoints = [(t, np.array(m.counts)) for t, m in frames if isinstance(m, Setpoint)]
    assert len(setpoints) > 100
    for _, counts in setpoints:
        assert (ranges[:, 0] <= counts).all()
        assert (counts <= ranges[:, 1]).all()
    for (before, a), (now, b) in itertools.pairwise(setpoints):
        if now - before < DEADLINE / 2:
            # The bridge's clock and ours, on a busy computer, differ by two periods at most.
            assert (np.abs(b - a) <= speeds * (now - before + 3 * PERIOD) + 1).all()
    steps = [
        (later[0] - earlier[0], np.abs(np.subtract(later[1], earlier[1])))
        for earlier, later in itertools.pairwise(rig.recorder.changes())
        if None not in (*earlier[1], *later[1])
    ]
    assert all((way <= speeds * (dt + 3 * PERIOD) + 1).all() for dt, way in steps)


def reconnections(rig, count):
    """Seconds from the end of each of the board's boots until the bridge has it again."""
    times = []
    for _ in range(count):
        rig.board.do(lambda: rig.recorder.board.reset(ResetCause.WATCHDOG))
        begun = time.monotonic()
        rig.user.spin(1.0)
        assert rig.user.machine_state.message in ('disconnected', 'booting')
        rig.user.wait('disarmed', lambda: rig.user.machine_state.message == 'disarmed', 10.0)
        times.append(time.monotonic() - begun - BOOT)
    return times


@pytest.mark.parametrize('kind', MACHINES)
def test_hundreds_of_faults_crash_nothing_and_move_nothing_beyond_its_limits(kind, tmp_path):
    machine, reach = MACHINES[kind]
    faults = Faults(seed=1, per_minute=FAULTS_PER_MINUTE)
    with Rig(tmp_path, f'soak_{kind}', kind, machine, BOOT, faults) as rig:
        soak = Soak(rig, machine, reach, seed=2)
        soak.user.wait('motion', lambda: soak.user.motion('mode') != '', 15.0)
        taken = []
        for _ in range(3):
            taken.append(soak.go_on(SECONDS / 3))
        faults.calm()
        soak.is_calm = True
        soak.overrides.publish(Float64(data=1.0))
        rig.user.wait('calm', lambda: not faults.active, 10.0)
        soak.go_on(4.0)
        rig.user.go_to(soak.home)
        times = reconnections(rig, 2)
    told = f'{faults.counts.total()} faults, {soak.moves} goals, {soak.enablings} enablings'
    grown = np.diff(taken, axis=0)
    print(f'\n{kind}: {told}; again after boot: {np.round(times, 2)} s')
    for name, *more in zip(rig.names, *grown, strict=True):
        print(f'  {name}: {more[0]:+.2f}, {more[1]:+.2f} MB in the second and the last third')
    assert faults.counts.total() > FAULTS_PER_MINUTE / 60 * SECONDS / 2
    assert soak.moves > SECONDS / 5
    assert grown.sum(axis=0).max() < WARMING_UP
    assert grown[1].max() < (LEVEL if 2 / 3 * SECONDS > WARMING else WARMING_UP)
    assert max(times) < 3.0
    check_frames(rig)
