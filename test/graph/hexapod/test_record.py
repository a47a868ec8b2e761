"""`hexarm record` beside a running machine, read back by readers that are not ours."""

import contextlib
import itertools
import json
import resource
import signal
import struct
import subprocess
import sys
from collections import Counter
from pathlib import Path

import pytest
from diagnostic_msgs.msg import DiagnosticStatus
from geometry_msgs.msg import PoseStamped
from mcap.exceptions import EndOfFile
from mcap.records import Message
from mcap.stream_reader import StreamReader
from rclpy.serialization import deserialize_message
from rosbags.highlevel import AnyReader
from rosbags.typesys import Stores, get_typestore
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64

from hexarm import Robot
from manipulator.nodes.messages import seconds
from manipulator.nodes.qos import LATCHED as LATCHED_QUALITIES
from manipulator.pose import Pose

pytestmark = pytest.mark.graph

ROOT = Path(__file__).resolve().parents[3]
STREAMS = ('setpoint', 'joint_command', 'joint_states', 'pose')
LATCHED = ('machine_state', 'motion_status')


def has_written(user, path):
    """Waits until what the recorder had received is in the file: it is written each second."""

    def size():
        return path.stat().st_size if path.exists() else 0

    for _ in range(2):
        before = size()
        user.wait('what it writes', lambda before=before: size() > before)


def ends_with(process, status):
    said = process.communicate(timeout=120)[0]
    assert process.returncode == status, said
    return said


def messages_before_the_tear(path):
    """How many messages of an unfinished file mcap's own reader finds."""
    count = 0
    with path.open('rb') as file, contextlib.suppress(EndOfFile, struct.error):
        for record in StreamReader(file).records:
            count += isinstance(record, Message)
    return count


@pytest.fixture(scope='module')
def recording(hexapod_graph, user, hexarm, tmp_path_factory):
    """Two moves, recorded: the file, what the recorder said, the stamps that we heard."""
    path = tmp_path_factory.mktemp('recording') / 'move.mcap'
    user.make_ready()
    stamps = []
    user.node.create_subscription(
        PoseStamped, 'setpoint', lambda m: stamps.append(seconds(m.header.stamp)), 500
    )
    recorder = hexarm('record', 'hexapod', '-o', str(path))
    assert any(line.startswith('recording ') for line in iter(recorder.stdout.readline, ''))
    user.reach(Pose.from_xyz_rpy((0.0, 0.0, 0.047)))
    user.wait('who records goals', lambda: user.node.count_subscribers('goal_pose') > 1)
    user.reach(Pose.from_xyz_rpy((0.0, 0.0, 0.044)))
    has_written(user, path)
    recorder.send_signal(signal.SIGINT)
    return path, ends_with(recorder, 0), stamps


@pytest.fixture(params=[None, Stores.ROS2_JAZZY], ids=['own definitions', 'jazzy'])
def received(recording, request):
    """Every message by topic, decoded by rosbags with the file's definitions, or its own."""
    store = get_typestore(request.param) if request.param else None
    found = {}
    with AnyReader([recording[0]], default_typestore=store) as reader:
        for connection, _, raw in reader.messages():
            message = reader.deserialize(raw, connection.msgtype)
            found.setdefault(connection.topic, []).append(message)
    return found


def test_it_records_from_the_first_goal_after_it_says_so(user, hexarm, tmp_path):
    paths = (tmp_path / f'first_{k}.mcap' for k in itertools.count())
    user.make_ready()

    def go():
        path = next(paths)
        user.go_to(Pose.from_xyz_rpy((0.0, 0.0, 0.044)))
        recorder = hexarm('record', 'hexapod', '-o', str(path))
        lines = iter(recorder.stdout.readline, '')
        assert any(line.startswith('recording ') for line in lines)
        try:
            with Robot('/hexapod') as robot:
                known = robot._client.node.count_subscribers
                user.wait('who records goals', lambda: known('goal_pose') > 1)
                robot.move_to((0.0, 0.0, 0.047))
            has_written(user, path)
        finally:
            recorder.send_signal(signal.SIGINT)
        ends_with(recorder, 0)
        heights, results, goals = moves_in(path)
        assert goals == [0.047]
        assert 'moving' in results
        assert results[-1] == 'reached'
        assert min(heights) == pytest.approx(0.044, abs=1e-4)
        assert max(heights) == pytest.approx(0.047, abs=1e-4)

    user.persist(go)


def moves_in(path):
    """Heights of the setpoints, results and heights of the goals in a file."""
    heights, results, goals = [], [], []
    with AnyReader([path], default_typestore=get_typestore(Stores.ROS2_JAZZY)) as reader:
        for connection, _, raw in reader.messages():
            message = reader.deserialize(raw, connection.msgtype)
            if connection.topic == '/hexapod/setpoint':
                heights.append(message.pose.position.z)
            elif connection.topic == '/hexapod/goal_pose':
                goals.append(message.pose.position.z)
            elif connection.topic == '/hexapod/motion_status':
                results.append({pair.key: pair.value for pair in message.values}['result'])
    return heights, results, goals


def test_streams_and_latched_states_are_in_it(received):
    assert {f'/hexapod/{name}' for name in (*STREAMS, *LATCHED)} < set(received)
    assert 'enabled' in [state.message for state in received['/hexapod/machine_state']]
    assert received['/hexapod/pose'][-1].pose.position.z == pytest.approx(0.044, abs=2e-3)


def test_setpoints_that_another_listener_received_are_in_it(received, recording):
    recorded = {seconds(m.header.stamp) for m in received['/hexapod/setpoint']}
    there = {t for t in recording[2] if min(recorded) <= t <= max(recorded)}
    assert len(recorded) > 20
    # Publishers keep one message: on a busy computer either listener may miss some.
    assert len(there - recorded) < 0.5 * len(there)


def test_goal_of_a_publisher_that_stays_is_in_it(received):
    assert received['/hexapod/goal_pose'][-1].pose.position.z == 0.044


def test_the_count_that_it_reports_is_that_of_the_file(received, recording):
    count = sum(map(len, received.values()))
    assert f'{count:,} messages of {len(received)} topics' in recording[1]


def test_its_counts_are_there_for_programs(user, hexarm, tmp_path):
    path = tmp_path / 'counted.mcap'
    recorder = hexarm('record', 'hexapod', '-o', str(path), '--json', stderr=subprocess.PIPE)
    user.wait('a first chunk', lambda: path.exists() and path.stat().st_size > 20_000)
    recorder.send_signal(signal.SIGINT)
    status, said = user.end_of(recorder)
    summary = json.loads(said)
    assert (status, summary['file']) == (0, str(path))
    with AnyReader([path], default_typestore=get_typestore(Stores.ROS2_JAZZY)) as reader:
        counts = Counter(connection.topic for connection, _, _ in reader.messages())
    assert summary['counts'] == counts


def test_messages_are_stored_as_they_were_on_the_wire(recording):
    kinds = {'/hexapod/joint_states': JointState, '/hexapod/machine_state': DiagnosticStatus}
    with AnyReader([recording[0]]) as reader:
        stored = [(c.topic, raw) for c, _, raw in reader.messages() if c.topic in kinds]
    received = [deserialize_message(raw, kinds[topic]) for topic, raw in stored]
    joints = [m.name for m in received if isinstance(m, JointState)]
    assert joints[-1] == [f'crank_{i}' for i in range(1, 7)]
    assert 'enabled' in [m.message for m in received if isinstance(m, DiagnosticStatus)]


def test_qualities_are_those_of_the_publishers(recording):
    with AnyReader([recording[0]]) as reader:
        offered = {c.topic: c.ext.offered_qos_profiles for c in reader.connections}
    (latched,), (streamed,) = offered['/hexapod/machine_state'], offered['/hexapod/setpoint']
    assert (latched.durability.name, streamed.durability.name) == ('TRANSIENT_LOCAL', 'VOLATILE')
    assert {q.reliability.name for q in (latched, streamed)} == {'RELIABLE'}


def test_killed_recorder_loses_at_most_the_last_second(user, hexarm, tmp_path):
    path = tmp_path / 'killed.mcap'
    recorder = hexarm('record', 'hexapod', '-o', str(path))
    user.wait('a first chunk', lambda: path.exists() and path.stat().st_size > 20_000, 20.0)
    recorder.kill()
    recorder.wait(60)
    assert messages_before_the_tear(path) > 100


def test_full_disk_ends_it_with_one_line_and_a_readable_file(user, tmp_path):
    path = tmp_path / 'full.mcap'

    def small_files_only():
        resource.setrlimit(resource.RLIMIT_FSIZE, (60_000, 60_000))

    done = subprocess.run(
        [sys.executable, '-m', 'hexarm', 'record', '-o', str(path), '--for', '60'],
        cwd=ROOT,
        preexec_fn=small_files_only,
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert done.returncode == 1
    assert done.stderr.count('\n') == 1, done.stderr
    assert f'hexarm: {path}: File too large; what was written before' in done.stderr
    assert messages_before_the_tear(path) > 100


def test_only_the_topics_asked_for_and_what_never_was(enabled, hexarm, tmp_path):
    path = tmp_path / 'one.mcap'
    wrong = 'there is no topic /hexapod/joint_sates, did you mean /hexapod/joint_states'
    words = ('-o', str(path), '--topics', 'pose', 'joint_sates')
    recorder, said = hexarm('record', 'hexapod', *words), ''
    for line in iter(recorder.stdout.readline, ''):
        said += line
        if wrong in said and 'recording ' in said:
            break
    has_written(enabled, path)
    recorder.send_signal(signal.SIGINT)
    said += ends_with(recorder, 0)
    assert said.count(wrong) == 2, 'once while it runs, once at its end'
    with AnyReader([path]) as reader:
        assert {c.topic for c in reader.connections} == {'/hexapod/pose'}


def test_it_reports_that_it_records_only_once_it_has_met_publishers(user, hexarm, tmp_path):
    recorder = hexarm('record', 'later', '-o', str(tmp_path / 'later.mcap'))
    assert recorder.stdout.readline() == 'waiting for publishers of /later\n'
    said = recorder.stdout.readline()
    assert said.startswith('no machine found in /later on ROS domain')
    assert said.endswith('; still waiting, Ctrl-C ends it\n')
    publisher = user.node.create_publisher(Float64, '/later/voltage', 10)
    assert recorder.stdout.readline().startswith('recording /later into ')
    user.wait('the recorder', publisher.get_subscription_count)
    for _ in range(3):
        publisher.publish(Float64(data=7.4))
    has_written(user, tmp_path / 'later.mcap')
    recorder.send_signal(signal.SIGINT)
    ends_with(recorder, 0)
    user.node.destroy_publisher(publisher)
    with AnyReader([tmp_path / 'later.mcap']) as reader:
        received = [connection.topic for connection, _, _ in reader.messages()]
    assert received.count('/later/voltage') == 3


def test_namespace_without_a_machine_reports_that_and_leaves_no_file(hexarm, tmp_path):
    path = tmp_path / 'nothing.mcap'
    said = ends_with(hexarm('record', 'nobody', '-o', str(path), '--for', '1.5'), 1)
    assert 'no machine found in /nobody on ROS domain' in said
    assert not path.exists()


def test_misspelt_topic_alone_is_not_blamed_on_the_graph(user, hexarm, tmp_path):
    path = tmp_path / 'nothing.mcap'
    words = ('-o', str(path), '--for', '20', '--topics', 'poes')
    said = ends_with(hexarm('record', 'hexapod', *words), 1).splitlines()[-1]
    assert 'there is no topic /hexapod/poes, did you mean /hexapod/pose?' in said
    assert 'is it running' not in said
    assert not path.exists()


def test_listener_that_no_goal_can_reach_keeps_nobody_waiting(user):
    user.make_ready()
    odd = user.node.create_subscription(PoseStamped, 'goal_pose', print, LATCHED_QUALITIES)
    user.spin(1.0)
    user.reach(Pose.from_xyz_rpy((0.0, 0.0, 0.046)))
    user.node.destroy_subscription(odd)
    # An executor that is not spun before more comes for what was destroyed ends the process.
    user.wait('its end', lambda: user.spin(0.1) or user.node.count_subscribers('goal_pose') == 1)


def run_program(user, line):
    program = f'from hexarm import Robot\nwith Robot("/hexapod") as robot: {line}'
    pipes = {'stdout': subprocess.PIPE, 'stderr': subprocess.STDOUT, 'text': True}
    process = subprocess.Popen([sys.executable, '-c', program], cwd=ROOT, **pipes)
    status, said = user.end_of(process)
    assert status == 0, said


def test_recorder_of_commands_is_not_taken_for_the_machine(user, hexarm, tmp_path):
    path = tmp_path / 'commands.mcap'
    user.make_ready()
    recorder = hexarm('record', 'hexapod', '--commands', '-o', str(path))
    user.wait('the recorder', lambda: user.node.count_subscribers('goal_pose') > 1)
    for z in (0.043, 0.045, 0.047):
        user.persist(lambda z=z: run_program(user, f'robot.move_to((0, 0, {z}))'))
    user.persist(lambda: run_program(user, 'robot.emergency_stop()'))
    recorder.send_signal(signal.SIGINT)
    ends_with(recorder, 0)
    user.make_ready()
