"""Gravity in any direction, and machines that hang, for every kind of machine."""

from dataclasses import fields, replace
from types import SimpleNamespace

import numpy as np
import pytest

from hexapod_control.workspace import sample
from hexarm.machine_check import problems_of
from hexarm.machines import find, load, read, text_of
from hexarm.pictures.animation import shapes
from hexarm.simulation.inverse_dynamics import InverseDynamics
from hexarm.simulation.model import dynamics_of, mechanism
from hexarm.simulation.rigid_body import RigidBody
from hexarm.simulation.sensors import carrying_force
from hexarm.simulation.simulation import Simulation
from hexarm.simulation.static_load import static_load
from leg_kinds import FLAT_CRANKS, HANGING_LEGS, RAILS
from manipulator.frames import ToolConfig
from manipulator.planning.plan import MotionState
from manipulator.pose import Pose

PLATFORMS = ['robocake', 'stewart_6_6', FLAT_CRANKS, RAILS]
SIDEWAYS = (3.0, -4.0, 1.0)
HALF_TURN = np.diag([1.0, -1.0, -1.0])
DRILL = ToolConfig('drill', (30.0, 0.0, 60.0), mass_g=400.0, centre_mm=(20.0, 5.0, 30.0))


def under(file, direction, **changes):
    """The machine file with gravity in a direction."""
    return replace(
        file, dynamics={**file.dynamics, 'gravity_direction': list(direction), **changes}
    )


def upside_down(kinematics):
    """The same platform in a base frame turned by half a turn about x."""
    geometry = kinematics.geometry
    turned = {
        f.name: getattr(geometry, f.name) @ HALF_TURN
        for f in fields(geometry)
        if f.init and np.shape(getattr(geometry, f.name)) == (6, 3)
    }
    turned['home_height'] = -geometry.home_height
    return replace(kinematics, geometry=replace(geometry, **turned))


@pytest.mark.parametrize('name', [*PLATFORMS, 'arm_6r'])
def test_efforts_that_hold_a_pose_are_the_slopes_of_the_potential_energy(example, name):
    """Of MuJoCo's masses, with its gravity as the file says: every kind, gravity askew."""
    this = example(name)
    file = replace(under(this.file, SIDEWAYS), tools=(DRILL,))
    home = this.kinematics.home
    joints = this.kinematics.inverse(home)
    simulation = Simulation(mechanism('m', file, this.kinematics), home, joints)
    expected = 9.80665 * np.array(SIDEWAYS) / 26**0.5
    np.testing.assert_allclose(simulation.model.opt.gravity, expected, rtol=1e-9)
    simulation.model.opt.enableflags |= 2
    by_work = static_load(this.kinematics, dynamics_of(file))(home, joints)
    for j in range(6):
        energy = []
        for step in (-1e-5, 1e-5):
            there = joints + step * np.eye(6)[j]
            simulation.reset(this.kinematics.forward(there, home).pose, there)
            energy.append(simulation.state.energy[0])
        slope = (energy[1] - energy[0]) / 2e-5
        assert slope == pytest.approx(by_work[j], rel=1e-4, abs=1e-4 * np.abs(by_work).max())


@pytest.mark.parametrize('name', ['robocake', 'stewart_6_6', 'arm_6r'])
def test_a_tool_is_held_by_as_much_as_its_weight_rises_with_each_joint(example, name):
    """Only the first of the tools is on the machine."""
    this = example(name)
    home, joints = this.kinematics.home, this.kinematics.inverse(this.kinematics.home)
    equipped = replace(this.file, tools=(DRILL, replace(DRILL, name='saw', mass_g=900.0)))
    bare, held = (
        static_load(this.kinematics, dynamics_of(file))(home, joints)
        for file in (this.file, equipped)
    )
    for j, step in enumerate(1e-6 * np.eye(6)):
        ends = [this.kinematics.forward(joints + s * step, home).pose for s in (1, -1)]
        up, down = (end.transform([[0.02, 0.005, 0.03]])[0, 2] for end in ends)
        assert (held - bare)[j] == pytest.approx(0.4 * 9.80665 * (up - down) / 2e-6, abs=1e-6)


def test_the_tool_of_a_stack_is_on_its_uppermost_platform():
    file, kinematics = read('stack_6_6'), load('stack_6_6').kinematics
    model = mechanism('stack', replace(file, tools=(DRILL,)), kinematics).xml
    assert model.count('tool_in_force') == 1


@pytest.mark.parametrize('name', PLATFORMS)
def test_a_machine_upside_down_carries_the_same_in_both_of_its_descriptions(name):
    """Home below the base and gravity down; or home above a base whose z points down."""
    machine, file = load(name), read(name)
    poses = sample(machine, 5, np.random.default_rng(2))
    hanging = upside_down(machine.kinematics)
    turned = Pose(poses.position @ HALF_TURN, HALF_TURN @ poses.rotation @ HALF_TURN)
    joints = machine.kinematics.inverse(poses)
    np.testing.assert_allclose(hanging.inverse(turned), joints, atol=1e-12)
    np.testing.assert_allclose(
        hanging.forward(joints[0]).pose.position, turned[0].position, atol=1e-9
    )
    plate = {**file.dynamics['platform'], 'centre_mm': [1.0, 2.0, 3.0]}
    mirrored = {**plate, 'centre_mm': [1.0, -2.0, -3.0]}
    nothing = {**file.dynamics['payload'], 'mass_g': 0.0}
    above = dynamics_of(under(file, (0, 0, 2), platform=plate, payload=nothing))
    below = dynamics_of(under(file, (0, 0, -9.81), platform=mirrored, payload=nothing))
    np.testing.assert_allclose(
        static_load(hanging, below)(turned, joints),
        static_load(machine.kinematics, above)(poses, joints),
        rtol=1e-9, atol=1e-12,
    )  # fmt: skip


def test_torque_at_rest_is_that_of_the_static_load_under_any_gravity(example):
    this = example('robocake')
    dynamics = dynamics_of(under(this.file, SIDEWAYS))
    home = this.kinematics.home
    at_rest = InverseDynamics(this.kinematics, dynamics)
    motion = MotionState(home, np.zeros(6), np.zeros(6))
    torques = at_rest.torques(motion, at_rest.cranks(motion))
    held = static_load(this.kinematics, dynamics)(home, this.kinematics.inverse(home))
    np.testing.assert_allclose(torques, held, rtol=1e-9)


def test_a_load_at_rest_is_carried_against_gravity():
    still = np.zeros((1, 6))
    home = Pose(np.zeros((1, 3)), np.eye(3)[None])
    gravity = np.array([0.0, 9.80665, 0.0])
    recording = SimpleNamespace(poses=home, twists=still, accelerations=still, gravity=gravity)
    force = carrying_force(recording, RigidBody(2.0, np.array([0.0, 0.1, 0.2]), np.eye(3)))
    np.testing.assert_allclose(force, [[0.0, -2 * 9.80665, 0.0]])


@pytest.mark.parametrize('name', ['robocake', 'stewart_6_6'])
@pytest.mark.parametrize('is_hanging', [False, True])
def test_the_base_is_drawn_on_the_side_where_no_platform_is(example, name, is_hanging):
    this = example(name)
    kinematics = upside_down(this.kinematics) if is_hanging else this.kinematics
    joints = kinematics.inverse(kinematics.home)
    drawn = shapes(Simulation(mechanism('m', this.file, kinematics), kinematics.home, joints))
    heights = np.concatenate(drawn.outlines[:2])[:, 2]
    away = -heights if is_hanging else heights
    assert away.min() < 0 <= abs(this.kinematics.home.position[2]) > away.max()


def test_a_hanging_machine_is_held_by_its_legs_in_simulation(example):
    """Every leg pulls, and the platform stands where the kinematics says but for the sag."""
    this = example(HANGING_LEGS)
    simulation = this.simulation()
    simulation.step(600)
    sag = this.kinematics.home.twist_to(simulation.pose)
    assert -1e-3 < sag[2] < 0
    assert np.abs(sag[[0, 1, 3, 4, 5]]).max() < 1e-5
    assert (simulation.watched().effort < 0).all()


def test_a_gravity_without_direction_is_named():
    text = text_of(find('robocake')).replace(
        'compensation: false', 'gravity_direction: [0.0, 0.0, 0.0]\n  compensation: false'
    )
    assert problems_of(text) == ['dynamics: gravity_direction: [0.0, 0.0, 0.0] is none']


def test_a_stack_has_a_gravity_of_its_own(example):
    this = example('stack_6_6')
    for direction, expected in (
        (None, [0.0, 0.0, -9.80665]),
        ([0.0, 2.0, 0.0], [0.0, 9.80665, 0.0]),
    ):
        own = None if direction is None else {'gravity_direction': direction}
        model = mechanism('m', replace(this.file, dynamics=own), this.kinematics)
        assert f'gravity="{" ".join(f"{v:.12g}" for v in expected)}"' in model.xml
