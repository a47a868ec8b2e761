"""One machine's whole chain without processes: pilot, command check, gate, session, board."""

from dataclasses import dataclass

import numpy as np
import pytest

from bridge.board_thread import FakeMachine
from bridge.calibration import Calibration
from bridge.command_gate import CommandGate
from bridge.events import FaultReported, StateReceived
from bridge.link_monitor import LinkMonitor
from bridge.messages import Arm
from bridge.servo_config import BoardConfig
from bridge.session import Session
from hexarm import machines
from manipulator.command_check import CommandCheck
from manipulator.errors import ManipulatorError
from manipulator.frames import Frames
from manipulator.pose import Pose
from manipulator.trajectory.pilot import Pilot
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
    """Ticks of 10 ms from the user's wishes to the board's pulses and back, in one time.

    times_of_a_tick: the steps in which the board's thread lets a tick pass; true_joints are heard
    after each. While `is_stalled` no setpoint gets through, as when ik is kept from running.
    """

    def __init__(self, name):
        self.machine = machines.load(name)
        config = BoardConfig.from_machine(machines.read(name))
        self.calibration = Calibration.from_config(config.servos)
        self.fake = FakeMachine.from_config(config, boot_s=0.0, hysteresis=config.hysteresis)
        self.board = self.fake.board
        self.session = Session(len(self.calibration.names))
        self.monitor = LinkMonitor(self.session, self.calibration)
        self.gate = CommandGate(self.calibration, 1e-3 * config.link.setpoint_deadline_ms)
        self.check = CommandCheck(self.machine)
        self.pilot = Pilot(self.machine, DT)
        self.teleop = Teleop(self.pilot, delay=0.06)
        self.park = self.calibration.counts(self.calibration.park)
        names = self.machine.kinematics.joint_names
        self._order = [self.calibration.names.index(n) for n in names]
        self._measured = None
        self._is_followed = False
        self.tick = 0
        self.sent, self.refusals, self.true_joints = [], [], []
        self.times_of_a_tick = lambda: [DT]
        self.is_stalled = False
        self.session.opened(self.now)

    @property
    def now(self):
        return 1000.0 + DT * self.tick

    def run(self, ticks):
        for _ in range(ticks):
            self._step()

    def until(self, word, ticks=400):
        for _ in range(ticks):
            if self.monitor.status.word == word:
                return
            self._step()
        raise AssertionError(f'{self.monitor.status} is not {word}')

    def enable(self):
        self.until('disarmed')
        self.arm()
        self.until('enabled')
        self.run(5)

    def arm(self):
        if self.monitor.status.word != 'enabled':
            self.ask(Arm(self.park))

    def ask(self, command):
        """As the bridge's services do; Refused where there is nothing to ask of."""
        self._hear(self.session.send_command(command, self.now))
        self.gate.restart()

    def _step(self):
        self.tick += 1
        for dt in self.times_of_a_tick():
            self.fake.step(dt)
            self.true_joints.append(self.fake.servos.positions[self._order])
        self._hear(self.session.receive(self.board.take_output(), self.now))
        self._hear(self.session.tick(self.now))
        self._is_followed = self._is_followed and self.monitor.status.word == 'enabled'
        word, is_measured = self.monitor.status.word, self.monitor.is_measured
        self.pilot.note_machine_state(word, self._is_followed, is_measured)
        self.teleop.drive(self.now)
        pose = self.pilot.step()
        if pose is not None and self._may_send() and not self.is_stalled:
            self._send(pose)
        self.board.feed(self.session.take_output())

    def _may_send(self):
        may = self.monitor.is_enabled_here and self.session.accepts_setpoints
        if not may:
            self.gate.restart()
        return may

    def _send(self, pose):
        pulses = np.array([np.nan if p is None else p for p in self.board.pulses])
        try:
            joints = self.check.admit(pose, self.now)
            setpoint = self.gate.admit(
                self.calibration.names,
                self._of_all(joints),
                self.now,
                self.now,
                self.monitor.joints.positions,
            )
        except ManipulatorError as error:
            self.refusals.append(f'tick {self.tick}: {error}')
            return
        self.session.send_setpoint(setpoint, self.now)
        self._is_followed = True
        frames = self.pilot.machine.frames
        counts = np.array(setpoint.counts, dtype=float)
        mode = self.pilot.status.mode
        self.sent.append(
            Sent(
                self.tick,
                frames.pivot(pose),
                frames,
                mode == 'disabled',
                mode,
                joints,
                counts,
                pulses,
            )
        )

    def _of_all(self, joints):
        """Joints that the pose says nothing of, as a gripper, stay at park."""
        positions = self.calibration.park.copy()
        positions[self._order] = joints
        return positions.tolist()

    def _hear(self, events):
        for event in events:
            self.monitor.note(event, self.now)
            if isinstance(event, FaultReported):
                self.refusals.append(f'tick {self.tick}: the board: {event.fault}')
            if isinstance(event, StateReceived):
                self._note_joints()

    def _note_joints(self):
        positions = self.monitor.joints.positions[self._order]
        if not np.isfinite(positions).all():
            self._measured = None
            self.check.note_joints(None)
            return
        near = self._measured
        self._measured = self.machine.kinematics.forward(positions, near).pose
        self.check.note_joints(positions)
        self.pilot.note_joints(positions)
        self.pilot.note_pose(self._measured)


@pytest.fixture
def loop_of():
    """A machine's chain by its name, enabled."""

    def make(name):
        loop = Loop(name)
        loop.enable()
        return loop

    return make
