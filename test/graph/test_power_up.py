"""What reaches the board, frame by frame: nothing unasked, and no jump."""

import itertools
import threading

import numpy as np
import pytest

from bridge.board_thread import BoardThread, FakeMachine
from bridge.calibration import Calibration
from bridge.fake_line import FakeLine
from bridge.framing import FrameReader
from bridge.messages import Arm, ResetCause, Setpoint
from bridge.servo_config import BoardConfig
from hexarm import machines
from hexarm.client import Client
from hexarm.graph import Graph, machine_graph
from hexarm.up import check_alive
from manipulator.pose import Pose

pytestmark = pytest.mark.graph

SPACE = 'power_up'


class TappedLine(FakeLine):
    """A line that keeps every frame which the host sends."""

    def __init__(self, path):
        super().__init__(path)
        self.frames = []
        self.lock = threading.Lock()
        self._reader = FrameReader()

    def read(self):
        received = super().read()
        with self.lock:
            self.frames += [frame.message for frame in self._reader.feed(received)]
        return received

    def heard(self):
        with self.lock:
            return list(self.frames)


@pytest.fixture
def rig(tmp_path, patient_robocake):
    """The whole graph of a RoboCake on a board of this process, whose line is tapped."""
    line = TappedLine(tmp_path / 'board')
    config = BoardConfig.from_machine(machines.read(patient_robocake))
    machine = FakeMachine.from_config(config, boot_s=0.2, hysteresis=0.0)
    board = BoardThread(machine, line, lambda positions: None)
    board.start()
    nodes = machine_graph('hexapod', patient_robocake, str(line.path), line.path)
    with Graph(nodes, SPACE) as graph, Client(SPACE, lambda: check_alive(graph)) as user:
        yield user, line, board, machine, Calibration.from_config(config.servos)
    board.close()


def setpoints(frames):
    return [np.array(frame.counts) for frame in frames if isinstance(frame, Setpoint)]


def test_nothing_moves_unasked_and_nothing_jumps(rig):
    user, line, board, machine, calibration = rig
    park = np.array(calibration.counts(calibration.park))

    user.wait('disarmed', lambda: user.machine_state.message == 'disarmed', 15.0)
    user.spin(1.0)
    assert line.heard() == []
    assert machine.board.pulses == (None,) * 6

    user.enable()
    frames = line.heard()
    assert isinstance(frames[0], Arm)
    assert list(frames[0].park) == park.tolist()
    assert all(np.abs(counts - park).max() <= 1 for counts in setpoints(frames))

    user.go_to(Pose.from_xyz_rpy((0.006, 0.0, 0.045), (0.0, 0.05, 0.0)))
    moved = setpoints(line.heard())
    limit = 2 * calibration.speed * abs(calibration.scale[0]) * 0.01
    steps = [np.abs(b - a).max() for a, b in itertools.pairwise(moved)]
    assert max(steps) <= limit
    assert np.abs(moved[-1] - park).max() > 50

    before = len(line.heard())
    board.do(lambda: machine.board.reset(ResetCause.POWER_ON))
    user.wait('the reset', lambda: user.machine_state.message != 'enabled', 10.0)
    user.wait('disarmed', lambda: user.machine_state.message == 'disarmed', 10.0)
    in_flight = len(line.heard())
    user.spin(1.0)
    assert len(line.heard()) == in_flight
    assert not any(isinstance(frame, Arm) for frame in line.heard()[before:])
    assert machine.board.pulses == (None,) * 6

    user.enable()
    again = setpoints(line.heard()[in_flight:])
    assert again
    assert all(np.abs(counts - park).max() <= 1 for counts in again)
