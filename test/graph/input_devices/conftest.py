"""What the tests of people's input devices share: a process of ours, and who listens to it."""

import os
import subprocess
import sys
from contextlib import contextmanager
from pathlib import Path

import pytest
from geometry_msgs.msg import TwistStamped
from std_msgs.msg import Bool, Float64, String
from std_srvs.srv import Trigger

from manipulator.nodes.qos import COMMAND, EVERY_WORD, LATCHED
from patient_user import PatientUser

ROOT = Path(__file__).resolve().parents[3]


@pytest.fixture(scope='session')
def words():
    """The command line of one executable."""

    def join(executable, namespace, **parameters):
        found = [sys.executable, '-m', 'hexarm.nodes', executable, '--ros-args']
        found += ['-r', f'__ns:=/{namespace}']
        for name, value in parameters.items():
            found += ['-p', f'{name}:={value}']
        return found

    return join


@pytest.fixture(scope='session')
def running(words):
    """Runs the executable as a process, ended by its number."""

    @contextmanager
    def run(executable, namespace, **parameters):
        command = words(executable, namespace, **parameters)
        process = subprocess.Popen(command, cwd=ROOT, env=os.environ)
        try:
            yield process
        finally:
            if process.poll() is None:
                process.terminate()
            process.wait(60)

    return run


@pytest.fixture(scope='session')
def refusal(words):
    """Status and message of an executable that does not start."""

    def run(executable, **parameters):
        command = words(executable, 'refused', **parameters)
        done = subprocess.run(
            command,
            cwd=ROOT,
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
            timeout=120,
            check=False,
        )
        return done.returncode, done.stderr.strip()

    return run


@pytest.fixture(scope='session')
def listening():
    """Makes a Listener."""
    return Listener


class Listener(PatientUser):
    """Hears what an input device sends, and answers as the trajectory node would."""

    def __init__(self, namespace, source):
        super().__init__(namespace)
        self.twists, self.modes, self.openings, self.asked = [], [], [], []
        self.stops, self.obeys = [], True
        node = self.node
        node.create_subscription(TwistStamped, f'cmd_vel/{source}', self._on_twist, 50)
        node.create_subscription(String, 'jog_mode', lambda m: self.modes.append(m.data), LATCHED)
        node.create_subscription(
            Float64, 'gripper', lambda m: self.openings.append(m.data), LATCHED
        )
        node.create_subscription(
            Bool, 'emergency_stop', lambda m: self.stops.append(m.data), EVERY_WORD
        )
        for name in ('home', 'stop'):
            node.create_service(Trigger, f'trajectory/{name}', self._answer(name))

    def joy_publisher(self, message_type, topic):
        """A publisher that somebody listens to."""
        publisher = self.node.create_publisher(message_type, topic, COMMAND)
        self.wait('a listener', lambda: publisher.get_subscription_count() > 0)
        return publisher

    def _on_twist(self, message):
        linear, angular = message.twist.linear, message.twist.angular
        numbers = (linear.x, linear.y, linear.z, angular.x, angular.y, angular.z)
        self.twists.append((numbers, message.header.frame_id))

    def _answer(self, name):
        def answer(request, response):
            self.asked.append(name)
            response.success = self.obeys
            return response

        return answer
