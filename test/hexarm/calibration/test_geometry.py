"""`hexarm calibrate poses` and `geometry`, from the file to the file."""

import csv
import json

import numpy as np
import pytest

from bridge.calibration import Calibration
from bridge.servo_config import BoardConfig
from hexapod_control.identification.leg_model import Tolerances
from hexarm.calibration.campaign import NOISE, some_frames, true_values
from hexarm.calibration.machine_writer import machine_model
from hexarm.calibration.poses import measurements
from hexarm.cli.main import main
from hexarm.machines import load, read
from manipulator.pose import Pose

COLUMNS = 7
"""The last ones: x, y, z in mm and a quaternion."""


def measured(folder, name, noise=NOISE, count=40):
    """A table as a person would fill it in, and the machine that was in truth before her."""
    path = folder / 'poses.csv'
    assert main(['calibrate', 'poses', name, '--count', str(count), '-o', str(path)]) == 0
    header, *rows = csv.reader(path.open())
    kinematics = load(name).kinematics
    unit = 1e-3 if kinematics.joint_unit == 'm' else np.radians(1.0)
    joints = unit * np.array([row[:6] for row in rows], dtype=float)
    model = machine_model(kinematics, Tolerances(1e-3, 0.01))
    generator = np.random.default_rng(11)
    true, frames = true_values(model, generator), some_frames(generator)
    poses = [kinematics.forward(q).pose for q in joints]
    near = Pose(np.stack([p.position for p in poses]), np.stack([p.rotation for p in poses]))
    seen = frames.seen(model.predict(true, joints, near))
    seen = seen.moved(generator.standard_normal((len(joints), 6)) / noise.weights)
    for row, place, turn in zip(rows, seen.position, seen.quaternion, strict=True):
        row[-COLUMNS:] = [f'{1e3 * x:.5f}' for x in place] + [f'{x:.8f}' for x in turn]
    with path.open('w', newline='') as file:
        csv.writer(file).writerows([header, *rows])
    return path, model, true, frames, joints, near


@pytest.mark.parametrize('name', ['robocake', 'stewart_6_6', 'arm_6r'])
def test_the_written_file_commands_the_true_machine_well(tmp_path, name, capsys):
    table, model, true, frames, joints, near = measured(tmp_path, name)
    mine = tmp_path / 'mine.yaml'
    words = ['calibrate', 'geometry', name, str(table), '--output', str(mine)]
    assert main([*words, '--json']) == 0
    found = json.loads(capsys.readouterr().out.splitlines()[-1])
    assert found['rms_after']['position'] < 1.2e-4 < 1.5e-4 < found['rms_before']['position']
    before, after = (Calibration.from_config(BoardConfig.from_machine(read(x)).servos)
                     for x in (name, str(mine)))  # fmt: skip
    shift = (after.centre - before.centre)[:6]
    kinematics = load(str(mine)).kinematics
    device, marker = (_pose(found[key]) for key in ('T_device_base', 'T_platform_marker'))
    truth = frames.seen(model.predict(true, joints, near))
    reported = [kinematics.forward(q + shift, p).pose for q, p in zip(joints, near, strict=True)]
    errors = [
        (device @ pose @ marker).position - true_pose
        for pose, true_pose in zip(reported, truth.position, strict=True)
    ]
    assert np.sqrt(np.mean(np.square(errors))) < 7e-5


def _pose(reported):

    return Pose.from_xyz_quaternion(reported['xyz'], reported['quaternion_xyzw'])


def test_people_read_errors_parameters_and_what_is_not_seen(tmp_path, capsys):
    table, *_ = measured(tmp_path, 'stewart_6_3', count=12)
    before = list(tmp_path.iterdir())
    assert main(['calibrate', 'geometry', 'stewart_6_3', str(table), '--dry-run']) == 0
    said = capsys.readouterr().out
    assert 'few poses: 72 numbers for 54 parameters; measure 18 poses' in said
    assert 'leg 3 length offset' in said
    assert 'cannot see 12 combinations' in said
    assert list(tmp_path.iterdir()) == before


def test_a_mistake_in_a_row_is_found(tmp_path, capsys):
    table, *_ = measured(tmp_path, 'arm_6r')
    rows = list(csv.reader(table.open()))
    rows[17][-7] = str(float(rows[17][-7]) + 5.0)
    with table.open('w', newline='') as file:
        csv.writer(file).writerows(rows)
    assert main(['calibrate', 'geometry', 'arm_6r', str(table), '--dry-run']) == 0
    assert '(worst: measured pose 17)' in capsys.readouterr().out


GOOD = (
    'leg_1_mm,leg_2_mm,leg_3_mm,leg_4_mm,leg_5_mm,leg_6_m,x_mm,y_m,z_mm,roll_deg,pitch_deg,yaw_rad'
)
ROW = '190,190,190,190,190,0.19,1,0.002,186,0,90,0.5'


def test_each_column_has_its_unit(tmp_path):
    path = tmp_path / 'm.csv'
    path.write_text(f'\ufeff{GOOD}\n\n{ROW}\n190,190,190,190,190,0.19,,,,,,\n')
    found = measurements(str(path), [f'leg_{i}' for i in range(1, 7)], 'm')
    assert found.joints.tolist() == [pytest.approx([0.19] * 6)]
    assert found.poses.position[0].tolist() == pytest.approx([0.001, 0.002, 0.186])
    assert found.poses.rpy[0][1] == pytest.approx(np.pi / 2)


@pytest.mark.parametrize(
    ('text', 'said'),
    [
        ('', 'needs a header and rows'),
        (f'{GOOD}\n190,x', 'line 2: 2 cells under 12 columns'),
        (f'{GOOD}\n{ROW.replace("186", "high")}', "line 2: z_mm is 'high', no number"),
        (f'{GOOD}\n{ROW.replace("186", "nan")}', "line 2: z_mm is 'nan', no number"),
        (f'{GOOD.replace("z_mm", "z_km")}\n{ROW}', 'needs one column z_mm or z_m; there are'),
        (f'{GOOD}\n190,190,190,190,190,0.19,,,,,,', 'no row has a measured pose'),
        (f'{GOOD}\n{ROW}', 'the frames need 3 at least'),
        (f'{GOOD}\n{ROW.replace("190", "900", 1)}', 'measured pose 1: '),
    ],
)
def test_a_table_that_cannot_be_used_is_refused_in_words(tmp_path, text, said, capsys):
    path = tmp_path / 'm.csv'
    path.write_text(text)
    assert main(['calibrate', 'geometry', 'stewart_6_6', str(path), '--dry-run']) == 2
    assert said in capsys.readouterr().err


@pytest.mark.parametrize(
    ('words', 'said'),
    [
        (['geometry', 'robocake', 'no.csv'], '--output my_robocake.yaml'),
        (
            ['geometry', 'robocake', 'no.csv', '--dry-run'],
            'no.csv cannot be read: No such file or directory\n',
        ),
        (['geometry', 'robocake', 'no.csv', '--dry-run', '--noise-mm', '0'], 'position noise 0'),
        (['geometry', 'robocake', 'no.csv', '--dry-run', '--tolerance-mm', '-1'], '-1 outside'),
        (['poses', 'robocake', '--count', '0'], '--count 0 outside'),
        (['poses', 'arm_6r', '--count', '2', '-o', '/nowhere/x.csv'], 'cannot be written'),
    ],
)
def test_what_cannot_be_done_is_refused_in_words(words, said, capsys):
    assert main(['calibrate', *words]) != 0
    assert said in capsys.readouterr().err


def test_a_table_that_is_there_is_not_overwritten(tmp_path, capsys):
    path = tmp_path / 'poses.csv'
    path.write_text('mine')
    assert main(['calibrate', 'poses', 'robocake', '-o', str(path)]) != 0
    assert 'not overwritten' in capsys.readouterr().err
    assert path.read_text() == 'mine'
