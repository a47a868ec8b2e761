"""The shipped keyboard_teleop process behind a real pseudo-terminal."""

import fcntl
import os
import pty
import select
import subprocess
import termios
import threading

import pytest

pytestmark = pytest.mark.graph
NAMESPACE = 'keyboards'
ZERO = (0.0,) * 6
PATIENCE = 60.0


def own_terminal():
    """Makes standard input the terminal whose keys interrupt the process."""
    fcntl.ioctl(0, termios.TIOCSCTTY, 0)


class Typist:
    """Sits at a terminal in which keyboard_teleop runs."""

    def __init__(self, command, listener, root):
        self.keys, self.screen = pty.openpty()
        self.before = termios.tcgetattr(self.screen)
        self.listener = listener
        self.seen = b''
        self.process = subprocess.Popen(
            command,
            cwd=root,
            stdin=self.screen,
            stdout=self.screen,
            start_new_session=True,
            preexec_fn=own_terminal,  # noqa: PLW1509 (one ioctl)
        )
        self.is_leaving = False
        self._reading = threading.Thread(target=self._read, daemon=True)
        self._reading.start()
        listener.wait('the help', lambda: b'SPACE' in self.seen)
        self.type_until(b' ', lambda: 'stop' in listener.asked)
        self.type_until(b'w', lambda: listener.twists)
        self.await_last(ZERO)
        listener.spin(0.2)
        listener.twists.clear()
        listener.asked.clear()

    def _read(self):
        while not self.is_leaving:
            self.seen += os.read(self.keys, 4096)

    def type(self, characters):
        os.write(self.keys, characters)

    def type_until(self, key, is_so):
        """Holds a key, as long as the graph needs to connect."""
        for _ in range(round(10 * PATIENCE)):
            self.type(key)
            self.listener.spin(0.1)
            if is_so():
                return
        raise AssertionError(f'{key} had no effect')

    def await_last(self, twist):
        twists = self.listener.twists
        self.listener.wait(f'{twist}', lambda: twists and twists[-1][0] == twist, PATIENCE)

    def await_twist(self, *twist, frame='base'):
        """Whether or not others followed it already."""
        self.listener.wait(f'{twist}', lambda: (twist, frame) in self.listener.twists, PATIENCE)

    def await_end(self):
        self.listener.wait('the end', lambda: self.process.poll() is not None, PATIENCE)
        return self.process.returncode

    def is_as_before(self):
        return termios.tcgetattr(self.screen) == self.before

    def close(self):
        if self.process.poll() is None:
            self.process.kill()
        self.process.wait(60)
        self.is_leaving = True
        os.write(self.screen, b'the end')
        self._reading.join()
        os.close(self.screen)
        os.close(self.keys)


@pytest.fixture(scope='module')
def shared(words, listening, request):
    command = words('keyboard_teleop', NAMESPACE)
    with listening(NAMESPACE, 'keyboard') as listener:
        typist = Typist(command, listener, request.config.rootpath)
        try:
            yield typist
        finally:
            typist.close()


@pytest.fixture
def typist(shared):
    """One who types on after the last test, in a process that goes on."""
    shared.listener.spin(0.5)
    for received in (shared.listener.twists, shared.listener.modes, shared.listener.asked):
        received.clear()
    return shared


def test_a_press_moves_and_ends_with_one_zero(typist):
    typist.type(b'w')
    typist.await_twist(0.02, 0, 0, 0, 0, 0)
    typist.await_last(ZERO)
    typist.listener.spin(0.3)
    twists = [twist for twist, _ in typist.listener.twists]
    assert twists.count(ZERO) == 1
    assert twists[-1] == ZERO


def test_space_ends_the_motion_and_asks_for_a_stop(typist):
    typist.type(b'jjj')
    typist.await_twist(0, 0, 0, 0, 0, 0.2)
    typist.type(b' ')
    typist.await_last(ZERO)
    typist.listener.wait('stop', lambda: typist.listener.asked == ['stop'], PATIENCE)


def test_mode_frame_gripper_and_home_reach_their_topics(typist):
    typist.type(b'mb')
    typist.listener.wait('mode', lambda: typist.listener.modes == ['hold_orientation'], PATIENCE)
    typist.type(b'r')
    typist.await_twist(0, 0, 0.02, 0, 0, 0, frame='tool')
    typist.type(b'v')
    typist.listener.wait('gripper', lambda: typist.listener.openings, PATIENCE)
    typist.type(b'h')
    typist.listener.wait('home', lambda: typist.listener.asked == ['home'], PATIENCE)
    line = b'mode hold_orientation, frame tool'
    typist.listener.wait('the line', lambda: line in typist.seen, PATIENCE)


def test_the_terminal_reports_who_listens(typist):
    typist.listener.wait('a line', lambda: b'a machine subscribes in /keyboards' in typist.seen)
    assert b'no machine subscribes' not in typist.seen.split(b'a machine subscribes')[-1]


def test_paste_moves_nothing(typist):
    typist.type(b'sudo apt install ros\n')
    typist.listener.spin(0.5)
    typist.type(b'm')
    typist.listener.wait('mode', lambda: typist.listener.modes, PATIENCE)
    assert typist.listener.twists == []


def test_ctrl_c_ends_it_with_a_zero_and_the_terminal_is_as_before(typist):
    """Keep it last: it ends the shared process."""
    assert not typist.is_as_before()
    typist.type_until(b'w', lambda: typist.listener.twists)
    typist.type(b'\x03')
    assert typist.await_end() == 0
    assert typist.is_as_before()
    typist.await_last(ZERO)


def test_a_keyboard_that_nobody_receives_reports_that_and_ends_with_its_window(words, request):
    keys, screen = pty.openpty()
    command = words('keyboard_teleop', 'lonely')
    process = subprocess.Popen(
        command, cwd=request.config.rootpath, stdin=screen, stdout=screen, stderr=screen
    )
    os.close(screen)
    seen = b''
    try:
        while b'no machine subscribes in /lonely on ROS domain' not in seen:
            assert select.select([keys], [], [], PATIENCE)[0], seen
            seen += os.read(keys, 4096)
        os.close(keys)
        assert process.wait(PATIENCE) == 0
    finally:
        process.kill()
        process.wait()
