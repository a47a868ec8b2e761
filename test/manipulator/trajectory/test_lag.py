import numpy as np
import pytest

from hexarm.machines import load
from manipulator.planning.goal import Goal
from manipulator.trajectory.controller import lag_of
from manipulator.trajectory.supervisor import MotionSupervisor

MACHINE = load('robocake')
HOME = MACHINE.kinematics.home
DT = 0.01


@pytest.fixture
def supervisor():
    """One that drives, at home."""
    made = MotionSupervisor(MACHINE, DT)
    made.note_machine_state('enabled', is_followed=True)
    made.note_joints(MACHINE.kinematics.inverse(HOME))
    made.note_pose(HOME)
    return made


def step(supervisor):
    pose = supervisor.step()
    supervisor.note_joints(MACHINE.kinematics.inverse(pose))
    return pose


def stream(supervisor, speed, seconds):
    """A goal each tick, away along x at `speed`; lags and poses."""
    lags, poses = [], []
    for k in range(round(seconds / DT)):
        supervisor.executor.pursue(Goal(HOME.moved([speed * k * DT, 0, 0, 0, 0, 0]), 0.0))
        poses.append(step(supervisor))
        lags.append(lag_of(supervisor)['lag_mm'])
    return lags, poses


def test_stream_within_the_limits_is_followed_closely(supervisor):
    lags, _ = stream(supervisor, 0.02, 0.4)
    assert 0.0 < max(lags) < 2.0


def test_stream_beyond_the_limits_is_pursued_within_them_and_its_lag_grows_and_ends(supervisor):
    lags, poses = stream(supervisor, 0.1, 0.12)
    speeds = np.diff([p.position[0] for p in poses]) / DT
    assert max(speeds) <= 0.05 * 1.005
    assert lags[-1] > 1.5 * lags[len(lags) // 2] > 2.0
    newest = 0.1 * 0.11
    assert lags[-1] == pytest.approx(1e3 * (newest - poses[-1].position[0]))
    for _ in range(100):
        last = step(supervisor)
    assert last.position[0] == pytest.approx(newest)
    assert lag_of(supervisor) == {'lag_mm': 0.0, 'lag_deg': 0.0}


def test_lag_is_a_distance_and_an_angle(supervisor):
    goal = HOME.moved([0.002, -0.001, 0.002, 0.02, 0.03, -0.04])
    supervisor.executor.pursue(Goal(goal, 0.0))
    pose, lag = step(supervisor), lag_of(supervisor)
    away = np.linalg.norm(goal.position - pose.position)
    turned = np.arccos((np.trace(goal.rotation @ pose.rotation.T) - 1) / 2)
    assert lag['lag_mm'] == pytest.approx(1e3 * away)
    assert lag['lag_deg'] == pytest.approx(np.degrees(turned))


def test_machine_that_nobody_drives_has_no_lag():
    assert lag_of(MotionSupervisor(MACHINE, DT)) == {'lag_mm': 0.0, 'lag_deg': 0.0}
