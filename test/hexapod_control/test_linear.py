import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hexapod_control import load
from hexapod_control.linear import LinearPlatform
from hexapod_control.linear_geometry import LinearGeometry, PlatesConfig
from hexapod_control.modes import all_modes
from hexapod_control.workspace import sample
from hexarm.papers.plane_method import PlaneMethod
from manipulator.config import build
from manipulator.errors import LimitViolated, NoSolution
from manipulator.machine import MachineFile
from manipulator.pose import Pose
from sampling import enough

PLATES = {'6-6': (50, 10), '6-3': (50, 0), '6-6 even base': (30, 5), '6-6 even top': (5, 30)}


@pytest.fixture(params=PLATES)
def platform(request):
    base, top = PLATES[request.param]
    return LinearPlatform(PlatesConfig(100, base, 50, top, 5, 5, 180).geometry(), 0.05, 0.2)


def distances(platform, pose):
    """Leg by leg, from the definition."""
    g = platform.geometry
    return [
        np.linalg.norm(pose.rotation @ top + pose.position - bottom)
        for top, bottom in zip(g.platform_points, g.base_points, strict=True)
    ]


def test_joints_are_the_distances_between_joint_centres(platform):
    pose = Pose.from_xyz_rpy((0.02, -0.03, 0.19), (0.2, -0.1, 0.3))
    np.testing.assert_allclose(platform.inverse(pose), distances(platform, pose), rtol=1e-13)


def test_many_poses_have_the_lengths_of_each_in_any_shape(platform):
    twists = np.random.default_rng(1).uniform(-0.1, 0.1, (3, 1000, 6))
    home = platform.home
    poses = Pose(np.tile(home.position, (3, 1000, 1)), home.rotation).moved(twists)
    lengths = platform.inverse(poses)
    assert lengths.shape == (3, 1000, 6)
    for index in [(0, 0), (1, 999), (2, 47), (2, 48), (2, 999)]:
        np.testing.assert_allclose(lengths[index], distances(platform, poses[index]), rtol=1e-13)


def test_joint_rates_are_how_lengths_follow_the_pose(platform):
    pose, step = Pose.from_xyz_rpy((0.02, -0.03, 0.19), (0.2, -0.1, 0.3)), 1e-6
    rates = platform.joint_rates(pose, platform.inverse(pose))
    for axis, twist in enumerate(np.eye(6) * step):
        slope = platform.inverse(pose.moved(twist)) - platform.inverse(pose.moved(-twist))
        np.testing.assert_allclose(rates[:, axis], slope / (2 * step), atol=1e-8)


def test_margin_does_not_depend_on_the_machines_size(platform):
    g = platform.geometry
    large = LinearPlatform(
        LinearGeometry(7 * g.base_points, 7 * g.platform_points, 7 * g.home_height), 0.35, 0.2
    )
    pose = Pose.from_xyz_rpy((0.02, -0.03, 0.19), (0.2, -0.1, 0.3))
    far = Pose(7 * pose.position, pose.rotation)
    margin = platform.sigma_min(pose, platform.inverse(pose))
    assert large.sigma_min(far, large.inverse(far)) == pytest.approx(margin, rel=1e-9)
    np.testing.assert_array_equal(platform.leverage(pose, platform.inverse(pose)), np.ones(6))


@pytest.mark.parametrize('length', [0.0, -0.15])
def test_a_leg_without_length_is_named(platform, length):
    legs = platform.inverse(platform.home)
    legs[3] = length
    with pytest.raises(NoSolution, match=r'leg 4: length -?0\.?\d* m is not above 0'):
        platform.forward(legs)


def test_a_cold_start_refuses_the_singular_quarter_turn(platform):
    """Above its home and turned by 90° about z, such a platform can turn on by itself."""
    pose = Pose.from_xyz_rpy(platform.home.position, (0.0, 0.0, np.pi / 2))
    legs = platform.inverse(pose)
    assert platform.sigma_min(pose, legs) < 1e-9
    with pytest.raises(NoSolution):
        platform.forward(legs)
    with pytest.raises(NoSolution, match='singularity'):
        platform.jacobian(pose, legs)


@given(st.integers(0, 2**32 - 1))
@settings(max_examples=enough(20, 40), deadline=None)
def test_any_linear_machine_closes_and_comes_back(seed):
    """Every joint off its circle by up to a tenth of the base's radius, in all directions."""
    generator = np.random.default_rng(seed)
    regular = PlatesConfig(100, 50, 50, 10, 5, 5, 187).geometry()
    machine = LinearPlatform(
        LinearGeometry(
            regular.base_points + generator.uniform(-0.01, 0.01, (6, 3)),
            regular.platform_points + generator.uniform(-0.01, 0.01, (6, 3)),
            regular.home_height,
        ),
        0.05,
        0.2,
    )
    twists = generator.uniform(-1, 1, (20, 6)) * ([0.03] * 3 + [0.15] * 3)
    start = Pose(np.tile(machine.home.position, (20, 1)), machine.home.rotation)
    poses = start.moved(twists)
    for k, legs in enumerate(machine.inverse(poses)):
        np.testing.assert_allclose(legs, distances(machine, poses[k]), rtol=1e-12)
        found = machine.forward(legs).pose
        assert np.abs(poses[k].twist_to(found)).max() < 1e-8


@pytest.mark.parametrize('name', ['stewart_6_3', 'stewart_6_6'])
def test_cold_starts_in_the_whole_workspace_never_end_in_another_mode(stewart_content, name):
    machine = load.hexapod(build(MachineFile, stewart_content(name)))
    poses = sample(machine, enough(400, 2000), np.random.default_rng(2))
    kinematics = machine.kinematics
    for k, legs in enumerate(kinematics.inverse(poses)):
        found = kinematics.forward(legs)
        assert np.abs(poses[k].twist_to(found.pose)).max() < 1e-8
        assert found.iterations <= 8


@pytest.mark.parametrize('name', ['stewart_6_3', 'stewart_6_6'])
def test_newton_the_plane_method_and_all_modes_agree(stewart_content, name):
    content = stewart_content(name)
    machine = load.hexapod(build(MachineFile, content))
    kinematics = machine.kinematics
    plane = PlaneMethod.of(build(PlatesConfig, content['geometry'], 'geometry'))
    poses = sample(machine, enough(15, 40), np.random.default_rng(8))
    for k, legs in enumerate(kinematics.inverse(poses)):
        newton = kinematics.forward(legs).pose
        by_plane = plane.solve(legs, newton.moved([2e-3, 1e-3, -2e-3, 0.03, 0.02, -0.04])).pose
        (by_all,) = all_modes(machine, legs).that_fit
        for pose in (newton, by_plane, by_all.pose):
            assert np.abs(poses[k].twist_to(pose)).max() < 1e-8


@pytest.mark.parametrize(
    ('xyz', 'rpy', 'words'),
    [
        ((0, 0, 0.24), (0, 0, 0), r'leg 1: leg length 0\.24\d* m outside \[0\.142, 0\.238\]'),
        ((0, 0, 0.13), (0, 0, 0), r'leg \d: leg length 0\.13\d* m outside'),
        ((0.13, 0, 0.12), (0, 0, 0), r'leg \d: base joint swing .* rad above 0\.7854'),
        ((0, 0, 0.187), (0, 0.75, 0), r'leg \d: platform joint swing .* rad above 0\.7854'),
        ((0, 0, 0.187), (0, 0, 1.5), r'singularity margin 0\.\d+ below 0\.25'),
    ],
)
def test_each_limit_speaks_for_itself(stewart_content, xyz, rpy, words):
    machine = load.hexapod(build(MachineFile, stewart_content('stewart_6_6')))
    pose = Pose.from_xyz_rpy(xyz, rpy)
    with pytest.raises(LimitViolated, match=words):
        machine.constraints.check(pose, machine.kinematics.inverse(pose))
