"""MuJoCo's models of the shipped machines stand where our kinematics says."""

from dataclasses import replace

import numpy as np
import pytest

from hexapod_control.workspace import sample
from hexarm.pictures.animation import shapes
from hexarm.simulation.dynamics_config import PlateConfig
from hexarm.simulation.model import dynamics_of, mechanism
from hexarm.simulation.rigid_body import plate, rod
from hexarm.simulation.simulation import DoesNotAssemble, Simulation
from hexarm.simulation.static_load import static_load
from leg_kinds import FLAT_CRANKS, RAILS, SCREW_LEGS, TILTED_CRANKS
from manipulator.errors import ConfigError
from sampling import enough

PLATFORMS = (
    'robocake', 'stewart_6_3', 'stewart_6_6', TILTED_CRANKS, FLAT_CRANKS, RAILS, SCREW_LEGS,
)  # fmt: skip
ARMS = ('arm_6r', 'ur5')


def poses_of(machine, count):
    generator = np.random.default_rng(4)
    if hasattr(machine.kinematics, 'chain'):
        limits = machine.kinematics.limits
        joints = generator.uniform(limits.low, limits.high, (count, 6))
        return machine.kinematics.chain.forward(joints), joints
    poses = sample(machine, count, generator)
    return poses, machine.kinematics.inverse(poses)


@pytest.mark.parametrize('name', PLATFORMS)
def test_assembly_closes_over_the_whole_workspace(example, name):
    """Chains from base to platform by MuJoCo, at joints by our inverse kinematics."""
    simulation = example(name).simulation()
    poses, joints = poses_of(example(name).machine, enough(60, 200))
    for k in range(len(joints)):
        simulation.reset(poses[k], joints[k])
        assert simulation.closure_errors().max() < 1e-9
        gap = simulation.pose.twist_to(poses[k])
        assert np.abs(gap).max() < 1e-9


@pytest.mark.parametrize('name', ARMS)
def test_arm_is_where_forward_kinematics_puts_it(example, name):
    simulation = example(name).simulation()
    poses, joints = poses_of(example(name).machine, 50)
    for k in range(50):
        simulation.reset(poses[k], joints[k])
        assert np.abs(simulation.pose.twist_to(poses[k])).max() < 1e-9


@pytest.mark.parametrize('name', PLATFORMS)
def test_closure_error_in_motion_stays_below_a_hundredth_of_a_millimetre(example, name):
    this = example(name)
    simulation, home = this.simulation(), this.kinematics.home
    assert simulation.step_time == 0.0005
    worst = 0.0
    for k in range(600):
        way = np.sin(2 * np.pi * k / 600) * np.array([4e-3, -3e-3, 3e-3, 0.05, -0.04, 0.05])
        simulation.aim(this.kinematics.inverse(home.moved(way)))
        simulation.step()
        worst = max(worst, simulation.closure_errors().max())
    assert 0 < worst < 1e-5
    solved = this.kinematics.forward(simulation.joints, simulation.pose).pose
    assert np.abs(simulation.pose.twist_to(solved)[:3]).max() < 1e-5


@pytest.mark.parametrize('name', PLATFORMS + ARMS)
def test_static_torque_is_that_of_virtual_work(example, name):
    """MuJoCo holds each pose by its drives alone; 2 % of the largest effort."""
    this = example(name)
    simulation = this.simulation()
    poses, joints = poses_of(this.machine, 6)
    load = static_load(this.kinematics, dynamics_of(this.file))
    drives = this.mechanism.drives
    for k in range(6):
        by_work = load(poses[k], joints[k])
        simulation.allow(100 * drives.effort)
        simulation.reset(poses[k], joints[k])
        simulation.aim(joints[k] + by_work / drives.stiffness)
        simulation.step(800)
        held = simulation.watched().effort
        assert np.abs(held - by_work).max() < 0.02 * np.abs(by_work).max()


@pytest.mark.parametrize('name', PLATFORMS + ARMS)
def test_static_load_is_the_slope_of_mujocos_potential_energy(example, name):
    this = example(name)
    simulation = this.simulation()
    simulation.model.opt.enableflags |= 2
    poses, joints = poses_of(this.machine, 5)
    load = static_load(this.kinematics, dynamics_of(this.file))(poses, joints)
    for k in range(5):
        for j in range(6):
            energy = []
            for step in (-1e-5, 1e-5):
                there = joints[k] + step * np.eye(6)[j]
                pose = this.kinematics.forward(there, poses[k]).pose
                simulation.reset(pose, there)
                energy.append(simulation.state.energy[0])
            slope = (energy[1] - energy[0]) / 2e-5
            assert slope == pytest.approx(load[k, j], rel=1e-4, abs=1e-5)


def test_a_leg_that_does_not_close_is_named(example):
    this = example('robocake')
    joints = this.kinematics.inverse(this.kinematics.home).copy()
    joints[3] += 0.02
    with pytest.raises(DoesNotAssemble, match=r'leg 4 does not close: its end is 0\.\d+ mm') as e:
        Simulation(this.mechanism, this.kinematics.home, joints)
    assert e.value.leg == 4


def test_a_payload_can_be_left_out(example):
    this = example('robocake')
    empty = mechanism('robocake', this.file, this.kinematics, payload_g=0.0)
    assert 'payload' in this.mechanism.xml
    assert 'payload' not in empty.xml


@pytest.mark.parametrize('payload_g', [-1.0, float('nan'), float('inf'), 1e12])
def test_impossible_payloads_are_refused(example, payload_g):
    with pytest.raises(ConfigError, match='payload'):
        dynamics_of(example('robocake').file, payload_g)


def test_sensors_agree_with_differences(example):
    """Twist, acceleration and rates against differences of poses, twists and joints."""
    this = example('robocake')
    simulation, home = this.simulation(), this.kinematics.home
    readings = []
    for k in range(120):
        way = 4e-3 * np.sin(2 * np.pi * k / 400) * np.array([1, 0, 1, 0, 0, 10.0])
        simulation.aim(this.kinematics.inverse(home.moved(way)))
        readings.append(simulation.watched())
    dt = simulation.step_time
    before, now = readings[-2:]
    assert now.time == pytest.approx(120 * dt)
    assert now.twist == pytest.approx(before.pose.twist_to(now.pose) / dt, rel=1e-4, abs=1e-6)
    assert now.rates == pytest.approx((now.joints - before.joints) / dt, rel=1e-6, abs=1e-6)
    assert now.acceleration == pytest.approx((now.twist - before.twist) / dt, rel=1e-6, abs=1e-6)
    assert np.linalg.norm(now.twist[:3]) > 0.01


def test_moments_of_shapes():
    """A plate's and a rod's moments, by summing points."""
    generator = np.random.default_rng(2)
    points = generator.uniform(-0.1, 0.1, (400_000, 3)) * [1, 1, 0.05]
    turns = np.arange(6) * np.pi / 3
    inside = (points[:, :2] @ [np.cos(turns), np.sin(turns)] <= 0.07).all(axis=1)
    squares = (points[inside] ** 2).mean(axis=0)
    body = plate(PlateConfig('estimate', 100.0, 10.0), 0.07)
    commanded = 0.1 * (squares.sum() - squares)
    assert np.diag(body.inertia) == pytest.approx(commanded, rel=0.01)
    along = np.linspace([0.01, 0.02, 0], [0.06, 0.02, 0.1], 20001)
    offset = along - along.mean(axis=0)
    slender = 0.05 * ((offset**2).sum() * np.eye(3) - offset.T @ offset) / len(along)
    thin = rod(0.05, 1e-5, along[0], along[-1])
    assert thin.inertia == pytest.approx(slender, rel=1e-3, abs=1e-9)
    assert thin.centre == pytest.approx(along.mean(axis=0))


@pytest.mark.parametrize(('minimum', 'bottom'), [(23.39, -30.0), (-50.0, -62.0)])
def test_the_lid_of_a_crank_platform_is_where_its_limit_is(example, minimum, bottom):
    """A level platform of 4 mm at its least height touches the lid; the body is below it."""
    this = example('robocake')
    limits = {**this.file.limits, 'minimum_height_mm': minimum}
    model = mechanism('robocake', replace(this.file, limits=limits), this.kinematics)
    home = this.kinematics.home
    simulation = Simulation(model, home, this.kinematics.inverse(home))
    corners = np.concatenate(shapes(simulation).outlines[:2])
    assert 1e3 * corners[:, 2].max() == pytest.approx(minimum - 2.0, abs=1e-3)
    assert 1e3 * corners[:, 2].min() == pytest.approx(bottom, abs=1e-3)


@pytest.mark.parametrize('name', ['robocake', 'stewart_6_6', 'linear_rails', 'stack_6_6'])
def test_drives_of_other_software_are_as_fast_as_joints_may_be(example, name):
    this = example(name)
    file = replace(this.file, driver='topic', servos={}, link={}, simulation=None)
    drives = mechanism('m', file, this.kinematics).drives
    np.testing.assert_allclose(drives.speed, this.machine.motion.joint.speed)
