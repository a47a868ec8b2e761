"""The serial bridge (bridge/nodes/, bridge/link_thread.py) without ROS, port or threads.

The driver and its link are the real ones; here stands what the node and the thread do around them.
"""

import numpy as np

from bridge.driver import BoardDriver
from bridge.framing import FrameReader
from bridge.programs import Upload
from manipulator.errors import ManipulatorError
from world.timeline import Process

SAY_AGAIN = 0.5


class Answer:
    """Of a service: none yet, '' for obeyed, or why not."""

    said = None


class Bridge(Process):
    """Joint commands and the board's bytes in; bytes, joints and the machine's state out.

    admitted and refusals: (time, joints) and (time, why) of joint commands; sent: (time, message)
    of what the session had written, whatever becomes of it on the cable.
    """

    def __init__(self, timeline, config, names, cable, words, joints):
        super().__init__(timeline)
        self.driver = BoardDriver(config, self, self.stamp - self.now)
        self.monitor, self._link = self.driver.monitor, self.driver.link
        self.admitted, self.refusals, self.sent, self.troubles = [], [], [], []
        self.states = []
        self._names = list(names)
        self._cable, self._words, self._joints = cable, words, joints
        self._order = [self.driver.calibration.names.index(name) for name in names]
        self._received, self._reader = b'', FrameReader()
        self._due_at = self.now
        self._wake()
        self.every(SAY_AGAIN, self._say_again)

    # As the node's callbacks do

    def ask(self, question):
        """As the services do: `question` asks the driver, the answer comes later."""
        answer = Answer()
        self.handle(lambda: self._ask(question, answer))
        return answer

    def send_all(self, commands):
        """One after the other, as with a program; the answer, '' for obeyed, comes later."""
        answer = Answer()
        self.handle(lambda: self._begin(commands, answer))
        return answer

    def aim_gripper(self, opening):
        """0 closed, 1 open; Refused says why not."""
        self.driver.aim_gripper(opening)

    def on_command(self, stamp, joints):
        try:
            self.driver.command(self._names, joints.tolist(), stamp, self.now)
        except ManipulatorError as error:
            self.monitor.refuse(str(error))
            self.refusals.append((self.now, str(error)))
        else:
            self.admitted.append((self.now, joints))
            self._wake()

    def on_joints(self, joints):
        positions = joints.positions[self._order]
        self._joints.send(self.stamp, positions if np.isfinite(positions).all() else None)

    def on_machine_state(self, state):
        reported = (state.status.state, state.is_followed, state.is_measured)
        if not self.states or self.states[-1][1] != reported:
            self.states.append((self.now, reported))
            self._words.send(*reported)

    def on_problem(self, text):
        self.troubles.append((self.now, text))

    def on_written(self, ticket, now):
        pass

    def _ask(self, question, answer):
        asked = question(self.driver)

        def settle(future):
            is_obeyed, text = self.driver.answer(asked)
            answer.said = '' if is_obeyed else text

        asked.future.add_done_callback(settle)
        self._wake()

    def _begin(self, commands, answer):
        def end(reason):
            answer.said = reason

        Upload(self._link.request, commands, end).begin()
        self._wake()

    def _say_again(self):
        if self.states:
            self._words.send(*self.states[-1][1])

    # As the thread does

    def on_bytes(self, received):
        if self._link.is_open:
            self._received += received
            self._turn()

    def on_unplugged(self):
        if self._link.is_open:
            self._received = b''
            self._link.lost('the cable was pulled', self.now)
            self._wake()

    def _wake(self):
        self.timeline.after(0.0, lambda: self.handle(self._turn))

    def _turn(self):
        link, now = self._link, self.now
        if link.wants_port(now):
            link.opened(now) if self._cable.is_plugged else link.lost('no cable', now)
        received = b''
        if link.is_listening(now):
            received, self._received = self._received, b''
        output = link.turn(received, now)
        self.sent += [(now, frame.message) for frame in self._reader.feed(output)]
        self._cable.send_to_board(output)
        link.written(b'', now)
        rest = link.due_in(now)
        self._due_at = now + rest
        self.timeline.after(rest, lambda: self.handle(self._turn_if_due))

    def _turn_if_due(self):
        if self.now >= self._due_at:  # else another turn came first
            self._turn()
