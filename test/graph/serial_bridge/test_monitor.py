"""`hexarm monitor` behind a real pseudo-terminal."""

import fcntl
import os
import pty
import re
import select
import struct
import subprocess
import sys
import termios
import time

import pytest

pytestmark = pytest.mark.graph

SPACE = 'bridge_rig'
LEAVES_SCREEN = re.escape(b'\x1b[?1049l')
PATIENCE = 60.0


def own_terminal():
    """Makes standard input the terminal whose keys interrupt the process."""
    fcntl.ioctl(0, termios.TIOCSCTTY, 0)


class Watched:
    """A monitor on a terminal of 40 lines, and all that it drew."""

    def __init__(self, root):
        self.keys, self.screen = pty.openpty()
        size = struct.pack('HHHH', 40, 160, 0, 0)
        fcntl.ioctl(self.screen, termios.TIOCSWINSZ, size)
        self.before = termios.tcgetattr(self.screen)
        self.seen = b''
        self.process = subprocess.Popen(
            [sys.executable, '-m', 'hexarm', 'monitor', SPACE],
            cwd=root,
            env=os.environ | {'TERM': 'xterm'},
            stdin=self.screen,
            stdout=self.screen,
            start_new_session=True,
            preexec_fn=own_terminal,  # noqa: PLW1509 (one ioctl)
        )

    def read_until(self, words):
        end = time.monotonic() + PATIENCE
        while not re.search(words, self.seen):
            assert time.monotonic() < end, self.seen[-4000:].decode(errors='replace')
            if select.select([self.keys], [], [], 0.1)[0]:
                self.seen += os.read(self.keys, 65536)

    def ends(self, key):
        os.write(self.keys, key)
        self.read_until(LEAVES_SCREEN)
        status = self.process.wait(PATIENCE)
        return status, termios.tcgetattr(self.screen) == self.before

    def close(self):
        if self.process.poll() is None:
            self.process.kill()
            self.process.wait()
        os.close(self.keys)
        os.close(self.screen)


@pytest.fixture
def monitor(request):
    watched = Watched(request.config.rootpath)
    yield watched
    watched.close()


@pytest.mark.parametrize('key', [b'q', b'\x03'])
def test_it_shows_the_link_and_leaves_the_terminal_as_it_was(rig, monitor, key):
    monitor.read_until(b'serial_bridge')
    for words in (b'battery_v 7.8', rb'link\S* \S*ready', b'machine disarmed'):
        monitor.read_until(words)
    assert monitor.ends(key) == (0, True)


def test_without_rich_it_reports_how_to_get_it(request):
    without = (
        'import sys; sys.modules["rich"] = None\n'
        'from hexarm.cli.main import main; sys.exit(main(["monitor"]))'
    )
    done = subprocess.run(
        [sys.executable, '-c', without],
        cwd=request.config.rootpath,
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert done.returncode == 1
    assert done.stderr == 'hexarm: needs the Python module rich: python3 -m pip install rich\n'
