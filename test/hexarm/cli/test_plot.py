"""`hexarm plot`: figures, tables and the picture of recordings whose content is known."""

import csv
import json
import math
import subprocess
import sys

import numpy as np
import pytest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from geometry_msgs.msg import PoseStamped
from matplotlib.image import imread
from rclpy.serialization import serialize_message
from sensor_msgs.msg import JointState
from std_msgs.msg import Bool

from hexarm.cli.main import main
from hexarm.recording.bag import Bag
from hexarm.recording.sink import Topic
from manipulator.pose import Pose

START = 1_700_000_000_000_000_000
OFF, TURNED = 0.5e-3, math.radians(1.0)
NAMES = ['crank_1', 'crank_2']


def stamped(pose):
    message = PoseStamped()
    p, q = message.pose.position, message.pose.orientation
    p.x, p.y, p.z = pose.position.tolist()
    q.x, q.y, q.z, q.w = pose.quaternion.tolist()
    return message


def status(name='', message='', **values):
    pairs = [KeyValue(key=k, value=v) for k, v in values.items()]
    return DiagnosticStatus(name=name, message=message, values=pairs)


def asked(t):
    return Pose.from_xyz_rpy((0.01 * math.sin(t), 0.0, 0.045), (0.0, 0.0, math.pi - 1.0 + t))


def conversation(count=500):
    """Setpoints every 20 ms of a machine that is always half a millimetre and one degree off."""
    off = Pose.from_xyz_rpy((OFF, 0.0, 0.0), (TURNED, 0.0, 0.0))
    yield 0.0, 'machine_state', status(message='enabled', reason='')
    for k in range(count):
        t = 0.02 * k
        yield t, 'setpoint', stamped(asked(t))
        yield t, 'joint_command', JointState(name=NAMES, position=[t, -t])
        done = asked(t) @ off
        yield t + 0.001, 'pose', stamped(done)
        # Velocities and efforts are empty, and a joint is unknown in the beginning.
        known = NAMES if t > 1.0 else NAMES[:1]
        positions = [t - 0.01, -t + 0.02][: len(known)]
        yield t + 0.002, 'joint_states', JointState(name=known, position=positions)
    yield 3.0, 'goal_pose', stamped(Pose.from_xyz_rpy((9.0, 0.0, 0.0), (0.0, 0.0, -1.2)))
    for t in (3.01, 3.02):
        refused = {
            'result': 'refused',
            'reason': 'leg 3: rod too short',
            'goal_stamp': f'{START * 1e-9 + 3.0:.9f}',
        }
        yield t, 'motion_status', status(**refused)
    yield 5.0, 'emergency_stop', Bool(data=True)
    yield 5.1, 'machine_state', status(message='stopped', reason='somebody pressed it')
    for t, count in ((6.0, '2'), (7.0, '2'), (8.0, '5')):
        node = status('hexapod/ik', setpoints_refused=count, last_refusal=f'leg 1 at {t:g}')
        yield t, '/diagnostics', DiagnosticArray(status=[node, status('arm/ik')])


def type_of(message):
    package, _, _ = type(message).__module__.partition('.')
    return f'{package}/msg/{type(message).__name__}'


def write(path, spaces=('hexapod',), is_finished=True, said=conversation):
    bag = Bag(path)
    for t, name, message in sorted(said(), key=lambda row: row[0]):
        for space in spaces:
            topic = name if name.startswith('/') else f'/{space}/{name}'
            if topic not in bag.counts:
                bag.add_type(type_of(message))
                bag.add_topic(Topic(topic, type_of(message)))
            bag.write(topic, serialize_message(message), START + round(t * 1e9))
    bag.flush()
    if is_finished:
        bag.__exit__(None)
    return path


@pytest.fixture(scope='module')
def recording(tmp_path_factory):
    return write(tmp_path_factory.mktemp('recording') / 'known.mcap')


def plotted(capsys, *words):
    assert main(['plot', *map(str, words), '--json']) == 0
    return json.loads(capsys.readouterr().out)


def table(path):
    with path.open() as file:
        return list(csv.DictReader(file))


def test_error_is_that_by_which_it_is_off(recording, tmp_path, capsys):
    reported = plotted(capsys, recording, '--csv', tmp_path)
    assert reported['error_rms_mm'] == pytest.approx(1e3 * OFF, abs=1e-6)
    assert reported['error_rms_deg'] == pytest.approx(1.0, abs=1e-6)
    assert (reported['setpoints'], reported['poses']) == (500, 500)


def test_refusals_of_goals_and_of_nodes_are_counted_once(recording, tmp_path, capsys):
    assert plotted(capsys, recording, '--csv', tmp_path)['refused'] == 1 + 2 + 3
    said = [(r['source'], r['what'], r['reason']) for r in table(tmp_path / 'events.csv')]
    assert said == [
        ('machine', 'enabled', ''),
        ('motion', 'refused', 'leg 3: rod too short'),
        ('user', 'emergency stop', ''),
        ('machine', 'stopped', 'somebody pressed it'),
        ('ik', 'refused', 'leg 1 at 6'),
        ('ik', 'refused', 'leg 1 at 8'),
    ]


def test_what_was_refused_before_the_recording_is_not_counted(tmp_path, capsys):
    """A late subscriber receives the last status, and nodes count from their own beginning."""
    stamp = f'{START * 1e-9 - 60.0:.9f}'
    old = status(result='refused', reason='leg 1: an hour ago', goal_stamp=stamp)
    node = status('hexapod/ik', setpoints_refused='7', last_refusal='an hour ago')

    def said():
        yield 0.001, 'motion_status', old
        yield 0.5, '/diagnostics', DiagnosticArray(status=[node])
        yield from (row for row in conversation() if row[1] != '/diagnostics')

    path = write(tmp_path / 'later.mcap', said=said)
    assert plotted(capsys, path, '--csv', tmp_path)['refused'] == 1
    reasons = [row['reason'] for row in table(tmp_path / 'events.csv')]
    assert 'leg 3: rod too short' in reasons
    assert not any('an hour ago' in reason for reason in reasons)


def test_tables_hold_what_was_reported_in_radians_and_metres(recording, tmp_path, capsys):
    plotted(capsys, recording, '--csv', tmp_path / 'new' / 'folder', '--from', 0.5, '--to', 2.5)
    folder = tmp_path / 'new' / 'folder'
    setpoints, joints = table(folder / 'setpoint.csv'), table(folder / 'joint_states.csv')
    assert len(setpoints) in (100, 101)
    for row in setpoints:
        t = float(row['time_s'])
        assert float(row['x_m']) == pytest.approx(0.01 * math.sin(t), abs=1e-8)
    yaw = np.array([float(row['yaw_rad']) for row in setpoints])
    assert np.abs(np.diff(yaw) - 0.02).max() < 1e-6, 'no jump by a whole turn'
    poses = {float(row['time_s']): float(row['yaw_rad']) for row in table(folder / 'pose.csv')}
    assert max(abs(yaw - (math.pi - 1.0 + t)) for t, yaw in poses.items()) < 0.01
    assert joints[0]['crank_2'] == 'nan'
    assert float(joints[-1]['crank_2']) == pytest.approx(
        0.02 - float(joints[-1]['time_s']), abs=3e-3
    )


def test_goal_is_reported_on_the_turn_of_the_setpoint(recording, tmp_path, capsys):
    plotted(capsys, recording, '--csv', tmp_path)
    (goal,) = table(tmp_path / 'goals.csv')
    assert float(goal['yaw_rad']) == pytest.approx(2 * math.pi - 1.2, abs=1e-6)


def test_picture_is_drawn_beside_the_recording(recording, capsys):
    assert main(['plot', str(recording)]) == 0
    picture = recording.with_suffix('.png')
    said = capsys.readouterr().out
    assert str(picture) in said
    assert '500 setpoints, 500 poses, 6 refused' in said
    pixels = imread(picture)
    assert min(pixels.shape[:2]) > 1000
    assert pixels.std() > 0.05, 'something is drawn'


def test_recording_that_was_torn_off_is_read_to_the_tear(tmp_path, capsys):
    whole = write(tmp_path / 'unfinished.mcap', is_finished=False)
    assert plotted(capsys, whole, '--csv', tmp_path)['setpoints'] == 500
    torn = tmp_path / 'torn.mcap'
    torn.write_bytes(whole.read_bytes()[:-7])
    assert plotted(capsys, torn, '--csv', tmp_path)['setpoints'] == 500


def test_recording_with_changed_bytes_is_distinguished_from_a_good_one(tmp_path, capsys):
    short = write(tmp_path / 'short.mcap', said=lambda: conversation(25))
    good, path = short.read_bytes(), tmp_path / 'changed.mcap'
    rng = np.random.default_rng(3)
    refused = 0
    for _ in range(40):
        changed = bytearray(good)
        changed[rng.integers(100, len(good))] ^= int(rng.integers(1, 256))
        path.write_bytes(changed)
        status = main(['plot', str(path), '--csv', str(tmp_path)])
        said = capsys.readouterr()
        assert status in (0, 2)
        refused += status == 2
        assert status == 0 or said.err.startswith('hexarm: ')
    assert refused > 10


def test_of_several_machines_one_is_chosen(tmp_path, capsys):
    path = write(tmp_path / 'two.mcap', ('hexapod', 'lab/arm'))
    assert main(['plot', str(path)]) == 2
    assert 'choose with --namespace: /hexapod, /lab/arm' in capsys.readouterr().err
    reported = plotted(capsys, path, '--namespace', '/lab/arm', '--csv', tmp_path)
    assert (reported['namespace'], reported['setpoints'], reported['refused']) == (
        'lab/arm',
        500,
        1,
    )
    assert main(['plot', str(path), '--namespace', 'leg']) == 2
    assert '/leg is not in this recording, only /hexapod, /lab/arm' in capsys.readouterr().err


def test_files_that_are_no_recordings(tmp_path, capsys):
    (tmp_path / 'bag').mkdir()
    (tmp_path / 'bag' / 'bag_0.db3').write_text('')
    (tmp_path / 'text.mcap').write_text('not a recording at all, but long enough to be read')
    with Bag(tmp_path / 'empty.mcap'):
        pass
    for name, reason in (
        ('none.mcap', 'none.mcap: No such file or directory'),
        ('text.mcap', 'text.mcap is not an MCAP file'),
        ('empty.mcap', 'there is no machine in this recording'),
        ('bag', 'is an SQLite bag: turn it into MCAP with `ros2 bag convert`'),
    ):
        assert main(['plot', str(tmp_path / name)]) == 2
        assert reason in capsys.readouterr().err


def test_times_beyond_the_recording_are_refused(recording, capsys):
    assert main(['plot', str(recording), '--from', '20']) == 2
    assert 'from 20 to 9.982 s: the recording has 10.0 s' in capsys.readouterr().err


def test_it_needs_no_ros(recording, tmp_path):
    without = 'import sys; sys.modules["rclpy"] = None; from hexarm.cli.main import main; '
    without += f'sys.exit(main(["plot", {str(recording)!r}, "--csv", {str(tmp_path)!r}]))'
    done = subprocess.run(
        [sys.executable, '-c', without], capture_output=True, text=True, timeout=60, check=False
    )
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize('module', ['mcap', 'mcap_ros2', 'matplotlib'])
def test_what_is_missing_is_named(recording, module):
    without = f'import sys; sys.modules[{module!r}] = None; from hexarm.cli.main import main; '
    without += f'sys.exit(main(["plot", {str(recording)!r}]))'
    done = subprocess.run(
        [sys.executable, '-c', without], capture_output=True, text=True, timeout=60, check=False
    )
    assert done.returncode == 1
    assert f'hexarm: needs the Python module {module}: ' in done.stderr
