"""What the serial bridge does (bridge/serial_bridge_node.py, link_thread.py), without ROS or port.

Its threads are one here; its word is said at every change and twice a second.
"""

import numpy as np

from bridge.command_gate import CommandGate
from bridge.events import Acknowledged, CommandFailed, StateReceived, without_passed_states
from bridge.link_monitor import LinkMonitor
from bridge.messages import Stop
from bridge.session import Session
from manipulator.errors import ManipulatorError, Refused
from world.timeline import Process

TICK, LOOK_AGAIN, SAY_AGAIN = 0.05, 0.25, 0.5


class Answer:
    """Of the board to a command: none yet, '' for obeyed, or why not."""

    said = None


class Bridge(Process):
    """Joint commands and the board's bytes in; bytes, joints and the machine's state out."""

    def __init__(self, timeline, machine, calibration, deadline, cable, words, joints):
        super().__init__(timeline)
        self.session = Session(len(calibration.names))
        self.monitor = LinkMonitor(self.session, calibration)
        self.gate = CommandGate(calibration, deadline)
        self.refusals, self.states = [], []
        self._calibration, self._cable = calibration, cable
        self._words, self._joints = words, joints
        names = machine.kinematics.joint_names
        self._order = [calibration.names.index(name) for name in names]
        self._is_followed = False
        self._asked = []
        self._is_open = False
        self.every(TICK, self._turn)
        self.every(LOOK_AGAIN, self._look)
        self.every(SAY_AGAIN, self._say_again)

    def ask(self, command):
        """As the services do: the answer comes when the board has obeyed, or will not."""
        answer = Answer()
        self.handle(lambda: self._ask(command, answer))
        return answer

    def on_command(self, stamp, joints):
        try:
            if not (self.monitor.is_enabled_here and self.session.accepts_setpoints):
                self.gate.restart()
                raise Refused(self.monitor.status.word)
            present = None if self.monitor.joints is None else self.monitor.joints.positions
            positions = self._calibration.park.copy()  # a gripper stays there
            positions[self._order] = joints
            names = self._calibration.names
            setpoint = self.gate.admit(names, positions.tolist(), stamp, self.now, present)
            self.session.send_setpoint(setpoint, self.now)
        except ManipulatorError as error:
            self.refusals.append((self.now, str(error)))
            return
        self._cable.send_to_board(self.session.take_output())
        self._is_followed = True

    def on_bytes(self, received):
        if self._is_open:
            self._note(without_passed_states(self.session.receive(received, self.now)))
            self._turn()

    def on_unplugged(self):
        if self._is_open:
            self._is_open = False
            self._note(self.session.closed('the cable was pulled', self.now))

    def _look(self):
        if not self._is_open and self._cable.is_plugged:
            self._is_open = True
            self._note(self.session.opened(self.now))

    def _turn(self):
        self._note(self.session.tick(self.now))
        self._cable.send_to_board(self.session.take_output())

    def _ask(self, command, answer):
        if isinstance(command, Stop):
            self.session.is_stop_wanted = True
        try:
            events = self.session.send_command(command, self.now)
        except Refused as error:
            answer.said = str(error)
            return
        self._note(events)
        self._asked.append((command, answer))
        self.gate.restart()
        self._cable.send_to_board(self.session.take_output())

    def _note(self, events):
        for event in events:
            self.monitor.note(event, self.now)
            if isinstance(event, Acknowledged | CommandFailed):
                self._settle(event)
            if isinstance(event, StateReceived):
                self._say_joints()
            self._say()

    def _settle(self, event):
        for command, answer in self._asked:
            if command == event.command:
                answer.said = '' if isinstance(event, Acknowledged) else event.reason
                self.gate.restart()
        self._asked = [entry for entry in self._asked if entry[0] != event.command]

    def _say_joints(self):
        positions = self.monitor.joints.positions[self._order]
        if np.isfinite(self.monitor.joints.positions).any():
            self._joints.send(self.stamp, positions if np.isfinite(positions).all() else None)

    def _say(self):
        word = self.monitor.status.word
        self._is_followed = self._is_followed and word == 'enabled'
        state = (word, self._is_followed, self.monitor.is_measured)
        if not self.states or self.states[-1][1] != state:
            self.states.append((self.now, state))
            self._words.send(*state)

    def _say_again(self):
        if self.states:
            self._words.send(*self.states[-1][1])
