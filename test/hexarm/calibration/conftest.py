"""A person at a terminal with `hexarm calibrate servos`, and the board that she looks at."""

import os
import pty
import select
import signal
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path

import pytest

from bridge.fake.board_thread import BoardThread, FakeMachine
from bridge.fake.fake_line import FakeLine
from bridge.servo_config import BoardConfig
from bridge.servo_wizard import STEPS_US
from hexarm import machines

ROOT = Path(__file__).resolve().parents[3]
PATIENCE, TRIES = 60.0, 5
LOST = ('no frame from the board', 'no answer', 'does not answer', 'no board is connected')
LOST += ('pull the',)  # the plug of servos that no board has confirmed to be off
RIGHT, LEFT = '\x1b[C', '\x1b[D'


class Screen:
    """`hexarm calibrate servos` on a terminal of its own."""

    def __init__(self, machine, port, *words):
        self.keys, screen = pty.openpty()
        command = [sys.executable, '-m', 'hexarm', 'calibrate', 'servos', str(machine)]
        self.process = subprocess.Popen(
            [*command, '--port', str(port), *words],
            cwd=ROOT,
            stdin=screen,
            stdout=screen,
            stderr=screen,
            start_new_session=True,
        )
        os.close(screen)
        self.said = self.all_said = ''

    def type(self, keys):
        os.write(self.keys, keys.encode())

    def hang_up(self):
        """The window is closed: nobody reads what is said from here on."""
        os.close(self.keys)
        self.keys = None

    def read(self):
        while self.keys is not None and select.select([self.keys], [], [], 0.02)[0]:
            try:
                words = os.read(self.keys, 4096).decode(errors='replace')
            except OSError:
                return
            self.said += words
            self.all_said += words

    def await_that(self, what, is_so):
        until = time.monotonic() + PATIENCE
        while not is_so():
            has_ended = self.process.poll() is not None
            self.read()
            can_come = not has_ended and time.monotonic() < until
            assert can_come or is_so(), f'{what} never came; the screen: {self.said[-2000:]}'
            time.sleep(0.01)

    def await_words(self, words):
        self.await_that(words, lambda: words in self.said)
        self.said = self.said[self.said.index(words) + len(words) :]

    def await_end(self):
        self.await_that('the end', lambda: self.process.poll() is not None)
        self.read()
        return self.process.returncode

    def close(self):
        if self.process.poll() is None:
            os.kill(self.process.pid, signal.SIGKILL)
        self.process.wait(PATIENCE)
        if self.keys is not None:
            self.hang_up()


class Person(Screen):
    """Types, reads the screen, and sees where the servos of the real machine stand."""

    def __init__(self, truth, folder, file, *words):
        self.file, self.port = file, folder / 'board'
        self.step = STEPS_US.index(20.0)
        self.machine = FakeMachine.from_config(truth, boot_s=0.1, hysteresis=0.0)
        self.board = BoardThread(self.machine, FakeLine(self.port), lambda positions: None)
        self.board.start()
        super().__init__(file, self.port, *words)

    @property
    def pulses(self):
        return self.machine.board.pulses

    @property
    def positions(self):
        return self.machine.servos.positions

    def another(self):
        """Somebody else who wants the same board."""
        return Screen(self.file, self.port)

    def begin(self):
        self.await_words('ENTER energises')
        self.type('\r')
        self.await_words('crank_1, direction')

    def jog_to(self, channel, pulse_us):
        """By the arrow keys, in steps that fit, until the pulse is there."""
        while (way := pulse_us - self.pulses[channel] / 2) != 0.0:
            fitting = sum(step <= max(abs(way), STEPS_US[0]) for step in STEPS_US) - 1
            self.type(('+' if fitting > self.step else '-') * abs(fitting - self.step))
            self.step = fitting
            before = self.pulses[channel]
            self.type(RIGHT if way > 0 else LEFT)
            self.await_that('a move', lambda old=before: self.pulses[channel] != old)
            self.await_rest(channel)

    def await_rest(self, channel):
        last = None
        while self.pulses[channel] != last:
            last = self.pulses[channel]
            for _ in range(8):
                self.read()
                time.sleep(0.01)

    def close(self):
        super().close()
        self.board.close()


@pytest.fixture
def people():
    """Whoever sat down; their terminals and boards are closed at the end."""
    seated = []
    yield seated
    for person in seated:
        person.close()


@pytest.fixture
def persist(people):
    """Runs a session; once more where this computer stood still, so that its board was lost."""

    def persist(session):
        for _ in range(TRIES - 1):
            try:
                return session()
            except AssertionError:
                person = people[-1]
                person.read()
                if person.keys and not any(words in person.all_said for words in LOST):
                    raise
                people.pop().close()
        return session()

    return persist


@pytest.fixture
def sit_down(tmp_path, people):
    """A person with a machine whose servos are in truth otherwise than its file says."""

    def begin(wrong, *words):
        file = tmp_path / 'mine.yaml'
        file.write_text(machines.shipped()['robocake'].read_text())
        config = BoardConfig.from_machine(machines.read(str(file)))
        joints = list(config.servos.joints)
        for index, values in wrong.items():
            joints[index] = replace(joints[index], **values)
        servos = replace(config.servos, joints=tuple(joints), arm_interval_ms=20)
        person = Person(replace(config, servos=servos), tmp_path, file, *words)
        people.append(person)
        return person, file

    return begin
