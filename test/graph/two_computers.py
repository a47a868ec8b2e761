"""Drives a RoboCake whose bridge runs on another computer, and tells what happened, as JSON.

Run in the network namespace of the first computer, with the name of the other's and its interface,
and what to put before its processes. The board is in this process: its pulses cannot lie.
"""

import dataclasses
import json
import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path

import numpy as np

from bridge.calibration import Calibration
from bridge.fake.board_thread import BoardThread, FakeMachine
from bridge.fake.fake_line import FakeLine
from bridge.framing import FrameReader
from bridge.protocol import Setpoint
from bridge.servo_config import BoardConfig
from hexarm import machines
from hexarm.graph import Graph, check_alive, machine_graph
from manipulator.pose import Pose

sys.path.insert(0, str(Path(__file__).parents[1] / 'support'))
from patient_user import PatientUser

MACHINE = 'robocake'
SPACE = 'split'
STILL = 1.0
"""Seconds without a change of the pulses, after which the platform is at rest."""
HOME = machines.load(MACHINE).kinematics.home
GOAL = Pose.from_xyz_rpy((0.006, 0.0, 0.045), (0.0, 0.05, 0.0))


class TappedLine(FakeLine):
    """A line that keeps every setpoint that the host sends."""

    def __init__(self, path):
        super().__init__(path)
        self.setpoints = []
        self._reader = FrameReader()

    def read(self):
        received = super().read()
        messages = [frame.message for frame in self._reader.feed(received)]
        self.setpoints += [np.array(m.counts) for m in messages if isinstance(m, Setpoint)]
        return received


class Pulses(threading.Thread):
    """Notes when the board's pulses last changed."""

    def __init__(self, board):
        super().__init__(daemon=True)
        self._board = board
        self.now = board.pulses
        self.changed_at = time.monotonic()
        self.changes = 0

    @property
    def still_for(self):
        """Seconds since they changed for the last time."""
        return time.monotonic() - self.changed_at

    def run(self):
        while True:
            if self._board.pulses != self.now:
                self.now, self.changed_at = self._board.pulses, time.monotonic()
                self.changes += 1
            time.sleep(0.005)


def ip(*words):
    subprocess.run(['ip', *words], check=True, timeout=5)


def set_moving(user, pulses):
    """Starts a motion without an end, and waits until it is under way."""

    def start():
        user.go_to(HOME)
        user.trigger('trajectory/start_cycle')
        before = pulses.changes
        user.wait_while_driven('its motion', lambda: pulses.changes > before + 50)

    user.persist(start)


def cut_and_mend(user, line, pulses, namespace, interface):
    """What the board did while the link was cut, and with the first frames after it."""
    reported = {}

    def link(state):
        ip('-n', namespace, 'link', 'set', interface, state)

    set_moving(user, pulses)
    link('down')
    user.wait('rest', lambda: user.motion('mode') == 'disabled' and pulses.still_for > STILL)
    at_rest = pulses.changes
    user.spin(STILL)
    reported['changes_while_cut'] = pulses.changes - at_rest
    before, count = np.array(pulses.now), len(line.setpoints)
    link('up')
    ip('-n', namespace, 'route', 'add', '224.0.0.0/4', 'dev', interface)  # went with the link
    user.wait_driven('setpoints', lambda: len(line.setpoints) > count + 20)
    again = np.array(line.setpoints[count:])
    reported['jump_in_counts'] = float(np.abs(again[:20] - before).max())
    return reported


def main(namespace, interface, *prefix):
    config = BoardConfig.from_machine(machines.read(MACHINE))
    machine = FakeMachine.from_config(config, boot_s=0.2, hysteresis=0.0)
    with tempfile.TemporaryDirectory() as folder:
        line = TappedLine(Path(folder) / 'board')
        board = BoardThread(machine, line, lambda positions: None)
        board.start()
        pulses = Pulses(machine.board)
        pulses.start()
        *nodes, bridge = machine_graph(MACHINE, str(line.path), line.path, is_separate=True)
        far = dataclasses.replace(bridge, prefix=prefix)
        graph = Graph([*nodes, far], SPACE)
        with graph, PatientUser(SPACE, lambda: check_alive(graph)) as user:
            reported = drive(user, line, pulses, namespace, interface, config)
        board.close()
    print(json.dumps(reported))


def drive(user, line, pulses, namespace, interface, config):
    """All that the test wants to know."""
    user.make_ready()
    user.reach(GOAL)
    reported = cut_and_mend(user, line, pulses, namespace, interface)
    joints = machines.load(MACHINE).kinematics.inverse(GOAL)
    wanted = Calibration.from_config(config.servos).counts(joints)

    def away():
        return float(np.abs(np.array(pulses.now) - wanted).max())

    def arrive():
        user.go_to(GOAL)
        user.wait_while_driven('the goal', lambda: away() <= 2.0)

    user.make_ready()
    user.persist(arrive)
    reported['away_from_goal_in_counts'] = away()
    return reported


if __name__ == '__main__':
    main(*sys.argv[1:])
