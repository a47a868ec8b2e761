"""Motions in simulation, what they cost, and what the servos can do."""

from dataclasses import replace

import numpy as np
import pytest

from hexarm.simulation.experiment import run, unshifted
from hexarm.simulation.inverse_dynamics import InverseDynamics
from hexarm.simulation.limit_search import (
    PAPER_AMPLITUDE,
    Demand,
    LimitSearch,
    along,
    corners_out,
    in_phase,
    largest,
    lines,
    share_in_reach,
)
from hexarm.simulation.model import dynamics_of
from hexarm.simulation.static_load import Stalls, check_holds, static_load
from manipulator.errors import InvalidInput
from manipulator.planning.plan import MotionState

G = 9.80665
PAPER = Demand(0.150, 0.050, 0.3 * G)


@pytest.fixture(scope='session')
def robocake(example):
    return example('robocake')


@pytest.fixture(scope='session')
def recording(robocake):
    cycle = in_phase(robocake.kinematics.home, PAPER_AMPLITUDE, 1.0)
    return run(robocake.simulation(), robocake.kinematics, cycle, 1.0, unshifted)


def test_inverse_dynamics_agrees_with_mujoco_in_motion(robocake, recording):
    """Torques of the motion that MuJoCo made, rotors added, against its drives' efforts."""
    solver = InverseDynamics(robocake.kinematics, dynamics_of(robocake.file))
    motion = MotionState(recording.poses, recording.twists, recording.accelerations)
    cranks = solver.cranks(motion)
    torques = solver.torques(motion, cranks)
    rotors = robocake.mechanism.drives.rotor * cranks.accelerations
    assert np.abs(cranks.rates - recording.rates).max() < 1e-2 * np.abs(recording.rates).max()
    miss = np.abs(torques + rotors - recording.efforts)
    assert miss.max() < 0.02 * np.abs(recording.efforts).max()


def test_standing_still_costs_the_static_load(robocake):
    dynamics = dynamics_of(robocake.file)
    pose = robocake.kinematics.home.moved(np.array([4e-3, -2e-3, 3e-3, 0.05, 0.02, -0.04]))
    solver, motion = InverseDynamics(robocake.kinematics, dynamics), MotionState.at_rest(pose)
    cranks = solver.cranks(motion)
    load = static_load(robocake.kinematics, dynamics)(pose, cranks.angles)
    assert solver.torques(motion, cranks) == pytest.approx(load, rel=1e-9)


def test_recording_follows_the_sine(robocake, recording):
    speed = np.linalg.norm(recording.twists[:, :3], axis=1).max()
    assert speed == pytest.approx(2 * np.pi * 9e-3, rel=0.02)
    assert recording.times[-1] == pytest.approx(1.0)
    assert 1e-5 < np.linalg.norm(recording.errors[:, :3], axis=1).max() < 1.5e-3


def test_share_in_reach_is_the_largest(robocake):
    cycle = in_phase(robocake.kinematics.home, 3 * np.array(PAPER_AMPLITUDE), 1.0)
    part = share_in_reach(robocake.machine, cycle)
    assert 0.3 < part < 1.0
    assert share_in_reach(robocake.machine, replace(cycle, amplitude=part * cycle.amplitude)) == 1
    beyond = replace(cycle, amplitude=(part + 0.003) * cycle.amplitude)
    assert share_in_reach(robocake.machine, beyond) < 1


def test_about_half_of_the_papers_corners_are_out_of_reach(robocake):
    assert 20 <= corners_out(robocake.machine, np.array(PAPER_AMPLITUDE)) <= 44
    assert corners_out(robocake.machine, 0.1 * np.array(PAPER_AMPLITUDE)) == 0


def test_a_motion_that_never_repeats_is_refused(robocake):
    still = in_phase(robocake.kinematics.home, np.zeros(6), 1.0)
    with pytest.raises(InvalidInput, match='periods of 0 s'):
        run(robocake.simulation(), robocake.kinematics, still, 1.0, unshifted)


@pytest.mark.parametrize('name', ['payload', 'speed', 'acceleration'])
@pytest.mark.parametrize('is_together', [False, True])
def test_limits_hold_below_and_not_above(robocake, name, is_together):
    search = LimitSearch(
        robocake.kinematics,
        dynamics_of(robocake.file),
        robocake.mechanism.drives,
        lines(0.010)['z'],
    )
    limit = along(search, PAPER, name, is_together)
    holds = search.holds_together if is_together else search.holds_separately
    assert holds(replace(PAPER, **{name: 0.999 * limit}))
    assert not holds(replace(PAPER, **{name: 1.001 * limit}))


def test_more_torque_carries_more(robocake):
    dynamics, drives = dynamics_of(robocake.file), robocake.mechanism.drives
    found = [
        along(
            LimitSearch(robocake.kinematics, dynamics, d, lines(0.010)['x']),
            PAPER,
            'payload',
            True,
        )
        for d in (drives, drives.stronger(1.2 * drives.effort))
    ]
    assert found[1] > 1.1 * found[0]


def test_largest_finds_an_edge():
    assert largest(lambda x: x <= 12.5, 1.0) == pytest.approx(12.5, rel=2e-4)
    assert largest(lambda x: False, 1.0) == 0.0
    assert largest(lambda x: True, 1.0) == np.inf


def test_a_payload_that_stalls_reports_where(robocake):
    k, drives = robocake.kinematics, robocake.mechanism.drives
    cycle = in_phase(k.home, PAPER_AMPLITUDE, 1.0)
    poses = cycle.at(np.linspace(0, 1, 50)).pose
    joints = k.inverse(poses)
    check_holds(static_load(k, dynamics_of(robocake.file)), drives, k, poses, joints)
    heavy = static_load(k, dynamics_of(robocake.file, 4000.0))
    with pytest.raises(Stalls, match=r'crank_\d stalls at x .* z .*: needs 0\.\d+ N·m, ') as error:
        check_holds(heavy, drives, k, poses, joints)
    worst = np.abs(heavy(error.value.pose, k.inverse(error.value.pose)))
    assert worst.argmax() + 1 == error.value.joint
    assert worst.max() > drives.effort[0]


@pytest.mark.parametrize(('part', 'is_held'), [(0.9, True), (1.3, False)])
def test_simulation_stalls_where_the_static_load_predicts(robocake, part, is_held):
    """At home: the payload that takes the whole torque, a little less and a good deal more."""
    k, drives = robocake.kinematics, robocake.mechanism.drives
    angles = k.inverse(k.home)
    empty, kilogram = (
        static_load(k, dynamics_of(robocake.file, grams))(k.home, angles) for grams in (0, 1000)
    )
    payload = np.min((drives.effort - np.abs(empty)) / np.abs(kilogram - empty))
    simulation = robocake.simulation(payload_g=1000 * part * payload)
    simulation.aim(angles + drives.band * np.sign(empty))
    simulation.step(600)
    sunk = k.home.position[2] - simulation.pose.position[2]
    assert (sunk < 0.002) == is_held
