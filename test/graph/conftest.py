"""Real processes on a ROS domain of their own, on this computer only, stopped by pid."""

import contextlib
import os
import re
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from rclpy.qos import DurabilityPolicy, ReliabilityPolicy

from hexarm import panel_process
from manipulator.errors import TimedOut

MARK = f'HEXARM_TEST_RUN={os.getpid()}'
os.environ['HEXARM_TEST_RUN'] = str(os.getpid())
ROOT = Path(__file__).resolve().parents[2]
TRIES = 5


@pytest.fixture(scope='session', autouse=True)
def ports_of_their_own(worker):
    """Panels of tests that run at the same time do not look for a port in the same place."""
    panel_process.FIRST_PORT += panel_process.PORTS * worker


@pytest.fixture
def processes_left():
    """A function that tells which processes of this test run are alive, by pid."""
    return _processes_left


def _processes_left() -> dict[int, str]:
    """Every process that this test run started and that is still alive."""
    found = {}
    for entry in Path('/proc').iterdir():
        if not entry.name.isdigit() or int(entry.name) == os.getpid():
            continue
        try:
            if MARK in (entry / 'environ').read_text(errors='replace').split('\0'):
                found[int(entry.name)] = (entry / 'cmdline').read_text().replace('\0', ' ')
        except OSError:
            continue
    return found


@pytest.fixture(scope='session')
def hexarm():
    """Starts `hexarm …` as a process of its own; ends it when the tests are over."""
    started = []

    def start(*words, **options):
        command = [sys.executable, '-m', 'hexarm', *words]
        pipes = {'stdout': subprocess.PIPE, 'stderr': subprocess.STDOUT, 'text': True}
        process = subprocess.Popen(command, cwd=ROOT, **(pipes | options))
        started.append(process)
        return process

    yield start
    for process in started:
        if process.poll() is None:
            process.kill()
            process.wait()


# What `hexarm up` says where a stall had it lose its board.
LOST = 'no (frame|answer) from the board|the board has restarted|hexarm: (timed out|no answer)'


@pytest.fixture
def hexarm_up(hexarm):
    """Starts `hexarm up …` and reads until it says so; again where its board was lost."""

    def start(*words, until='and enabled'):
        for _ in range(TRIES):
            process, text = hexarm('up', *words), ''
            for line in process.stdout:
                text += line
                if until in line:
                    return process, text
            assert re.search(LOST, text), text
        raise AssertionError(text)

    return start


@pytest.fixture
def ends_parked():
    """Ends `hexarm up` by Ctrl-C: it parks, unless its board was lost by then. What it says."""

    def end(process):
        process.send_signal(signal.SIGINT)
        rest = process.stdout.read()
        assert process.wait(60) == 0, rest
        assert re.search('park|no frame from the board', rest), rest
        assert 'Traceback' not in rest
        return rest

    return end


@pytest.fixture(scope='session')
def patient_robocake(tmp_path_factory):
    """A RoboCake whose board waits longer for setpoints than a busy test machine may stall."""
    return robocake_with_deadline(1000, tmp_path_factory)


@pytest.fixture(scope='session')
def tolerant_robocake(tmp_path_factory):
    """A RoboCake whose board waits twice as long for setpoints, and less than tests freeze."""
    return robocake_with_deadline(400, tmp_path_factory)


def robocake_with_deadline(ms, tmp_path_factory):
    text = (ROOT / 'config' / 'robocake.yaml').read_text()
    patient = re.sub('setpoint_deadline_ms: .*', f'setpoint_deadline_ms: {ms}', text)
    path = tmp_path_factory.mktemp('machine') / 'robocake.yaml'
    path.write_text(patient)
    return str(path)


@pytest.fixture(scope='session')
def interfaces():
    """The tables of docs/interfaces.md, and what running nodes have of what they list."""
    return Interfaces()


class Interfaces:
    """Topics and services of nodes in a namespace: as written, and as they are."""

    EVERYWHERE = frozenset({'/diagnostics', '/rosout', '/parameter_events'})
    """Every node has these; the text above the tables says so."""

    OPTIONAL = frozenset({'/tf'})
    """There where tf2_msgs is installed."""

    ROS_OWN = ('parameter', 'type_description')

    @staticmethod
    def section(node):
        text = (ROOT / 'docs' / 'interfaces.md').read_text()
        return text.split(f'\n## {node}\n')[1].split('\n## ')[0]

    def documented(self, node):
        """{(kind, name): (type, QoS)} from the tables of one node."""
        row = r'^\| `([\w/]+)` \| (in|out|service) \| (\S+) \|([^|]*)\|'
        found = re.findall(row, self.section(node), re.MULTILINE)
        return {(kind, name): (message, qos.strip()) for name, kind, message, qos in found}

    def running(self, user, node, space='/hexapod'):
        """The same from the graph."""
        found = {}
        ask = user.node
        for kind, query, endpoints in (
            (
                'in',
                ask.get_subscriber_names_and_types_by_node,
                ask.get_subscriptions_info_by_topic,
            ),
            ('out', ask.get_publisher_names_and_types_by_node, ask.get_publishers_info_by_topic),
        ):
            for topic, types in query(node, space):
                if topic in self.EVERYWHERE | self.OPTIONAL:
                    continue
                known = {qos_text(e.qos_profile) for e in endpoints(topic) if e.node_name == node}
                found[kind, topic.removeprefix(f'{space}/')] = (types[0], ' or '.join(known))
        for service, types in ask.get_service_names_and_types_by_node(node, space):
            if not any(word in service for word in self.ROS_OWN):
                found['service', service.removeprefix(f'{space}/')] = (types[0], '')
        return found

    def assert_documented(self, user, node, section='', space='/hexapod'):
        """That a node is what is written of it, once all of it is discovered."""
        names = user.node.get_node_names_and_namespaces
        user.wait(f'the name of {node}', lambda: (node, space) in names())
        documented = self.documented(section or node)
        with contextlib.suppress(TimedOut):
            user.wait(f'all of {node}', lambda: self.running(user, node, space) == documented)
        assert self.running(user, node, space) == documented


def qos_text(profile):
    reliability = 'R' if profile.reliability == ReliabilityPolicy.RELIABLE else 'B'
    durability = 'L' if profile.durability == DurabilityPolicy.TRANSIENT_LOCAL else 'V'
    return f'{reliability} {durability}'
