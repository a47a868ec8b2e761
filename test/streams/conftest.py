"""One machine's whole chain without processes: supervisor, command check, driver, board."""

from dataclasses import dataclass

import numpy as np
import pytest

from bridge.driver import BoardDriver
from bridge.fake.board_thread import FakeMachine
from bridge.protocol import Arm
from bridge.servo_config import BoardConfig
from hexarm import machines
from manipulator.errors import ManipulatorError
from manipulator.frames import Frames
from manipulator.pose import Pose
from manipulator.setpoint_validator import SetpointValidator
from manipulator.trajectory.supervisor import MotionSupervisor
from manipulator.trajectory.teleop import Teleop

DT = 0.01


@dataclass(frozen=True)
class Sent:
    """One setpoint at its stations, and the pulses that the board put out when it came.

    is_first: the machine was taken over with it.
    """

    tick: int
    pivot: Pose
    frames: Frames
    is_first: bool
    mode: str
    joints: np.ndarray
    counts: np.ndarray
    pulses: np.ndarray


class Loop:
    """Ticks of 10 ms from the user's commands to the board's pulses and back, in one time.

    times_of_a_tick: the steps in which the board's thread lets a tick pass; true_joints are heard
    after each. While `is_stalled` no setpoint gets through, as when ik is kept from running.
    """

    def __init__(self, name):
        self.machine = machines.load(name)
        config = BoardConfig.from_machine(machines.read(name))
        self.fake = FakeMachine.from_config(config, boot_s=0.0, hysteresis=config.hysteresis)
        self.board = self.fake.board
        self.driver = BoardDriver(config, self)
        self.monitor, self._link = self.driver.monitor, self.driver.link
        self.check = SetpointValidator(self.machine)
        self.supervisor = MotionSupervisor(self.machine, DT)
        self.teleop = Teleop(self.supervisor, delay=0.06)
        calibration = self.driver.calibration
        self.park = calibration.counts(calibration.park)
        self._names = list(self.machine.kinematics.joint_names)
        self._order = [calibration.names.index(n) for n in self._names]
        self._measured = None
        self._state = ('', False, False)
        self._written = None
        self.tick = 0
        self.sent, self.refusals, self.true_joints = [], [], []
        self.times_of_a_tick = lambda: [DT]
        self.is_stalled = False
        self._link.opened(self.now)

    @property
    def now(self):
        return 1000.0 + DT * self.tick

    def run(self, ticks):
        for _ in range(ticks):
            self._step()

    def until(self, word, ticks=400):
        for _ in range(ticks):
            if self.monitor.status.state == word:
                return
            self._step()
        raise AssertionError(f'{self.monitor.status} is not {word}')

    def enable(self):
        self.until('disarmed')
        self.arm()
        self.until('enabled')
        self.run(5)

    def arm(self):
        if self.monitor.status.state != 'enabled':
            self.ask(Arm(self.park))

    def ask(self, command):
        """As the bridge's services do; Refused where there is nothing to ask of."""
        asked = self._link.request(command)
        self._turn()
        if asked.done():
            asked.result()

    def _step(self):
        self.tick += 1
        for dt in self.times_of_a_tick():
            self.fake.step(dt)
            self.true_joints.append(self.fake.servos.positions[self._order])
        self._turn(self.board.take_output())
        self.supervisor.note_machine_state(*self._state)
        self.teleop.drive(self.now)
        pose = self.supervisor.step()
        if pose is not None and not self.is_stalled:
            self._send(pose)

    def _turn(self, received=b''):
        output = self._link.turn(received, self.now)
        pulses = [np.nan if p is None else p for p in self.board.pulses]
        self.board.feed(output)
        self._link.written(b'', self.now)
        return np.array(pulses)

    def _send(self, pose):
        may_send = self.monitor.is_enabled_here and self.driver.session.accepts_setpoints
        try:
            joints = self.check.admit(pose, self.now)
            self.driver.command(self._names, joints.tolist(), self.now, self.now)
        except ManipulatorError as error:
            if may_send:
                self.refusals.append(f'tick {self.tick}: {error}')
            return
        pulses = self._turn()
        frames, mode = self.supervisor.machine.frames, self.supervisor.status.mode
        counts = np.array(self._written.setpoint.counts, dtype=float)
        is_first = mode == 'disabled'
        self.sent.append(
            Sent(self.tick, frames.pivot(pose), frames, is_first, mode, joints, counts, pulses)
        )

    # What the driver announces

    def on_machine_state(self, state):
        self._state = (state.status.state, state.is_followed, state.is_measured)

    def on_written(self, ticket, now):
        self._written = ticket

    def on_problem(self, text):
        if text.startswith('the board: '):
            self.refusals.append(f'tick {self.tick}: {text}')

    def on_joints(self, joints):
        positions = joints.positions[self._order]
        if not np.isfinite(positions).all():
            self._measured = None
            self.check.note_joints(None)
            return
        near = self._measured
        self._measured = self.machine.kinematics.forward(positions, near).pose
        self.check.note_joints(positions)
        self.supervisor.note_joints(positions)
        self.supervisor.note_pose(self._measured)


@pytest.fixture
def loop_of():
    """A machine's chain by its name, enabled."""

    def make(name):
        loop = Loop(name)
        loop.enable()
        return loop

    return make
