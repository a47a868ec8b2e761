import numpy as np
import pytest

from hexapod_control.assembly_modes import _null_space, assembly_modes
from hexapod_control.geometry import HexagonConfig
from hexapod_control.linear_geometry import joint_circle
from manipulator import rotation as so3
from manipulator.errors import InvalidInput, NoSolution
from manipulator.pose import Pose
from newton import Newton, lengths_at
from sampling import enough

# P. Dietmaier, The Stewart-Gough platform of general geometry can have 40 real postures, 1998.
DIETMAIER_BASE = [
    (0, 0, 0),
    (1.107915, 0, 0),
    (0.549094, 0.756063, 0),
    (0.735077, -0.223935, 0.525991),
    (0.514188, -0.526063, -0.368418),
    (0.590473, 0.094733, -0.205018),
]
DIETMAIER_PLATFORM = [
    (0, 0, 0),
    (0.542805, 0, 0),
    (0.956919, -0.528915, 0),
    (0.665885, -0.353482, 1.402538),
    (0.478359, 1.158742, 0.107672),
    (-0.137087, -0.235121, 0.353913),
]
DIETMAIER_LENGTHS = [1, 0.645275, 1.086284, 1.503439, 1.281933, 0.771071]

ROBOCAKE = HexagonConfig(71.492, 25.0, 5.79, 17.5, 58.0, 1.5, 30.0, 41.19).geometry()


def circle(radius, degrees):
    return joint_circle(radius, np.radians(degrees))


def random_pose(random, height, turn):
    rotation = so3.exp(random.uniform(-turn, turn, 3))
    return Pose(random.normal(size=3) * 0.1 * height + [0, 0, height], rotation)


def general(random):
    return random.normal(size=(6, 3)), random.normal(size=(6, 3))


def planar_base(random):
    return random.normal(size=(6, 3)) * [1, 1, 0], random.normal(size=(6, 3))


def planar_platform(random):
    return random.normal(size=(6, 3)), random.normal(size=(6, 3)) * [1, 1, 0]


def both_planar(random):
    return random.normal(size=(6, 3)) * [1, 1, 0], random.normal(size=(6, 3)) * [1, 1, 0]


def almost_planar(random):
    return both_planar(random)[0] + 1e-4 * random.normal(size=(6, 3)), both_planar(random)[1]


def crank_tips(random):
    angle = np.radians(120) + random.uniform(-1.0, 1.0, (6, 1))
    crank = np.cos(angle) * ROBOCAKE.tangents + np.sin(angle) * ROBOCAKE.ups
    tips = ROBOCAKE.crank_centres + ROBOCAKE.crank_lengths[:, None] * crank
    return 20 * tips, 20 * ROBOCAKE.platform_points


def paired_6_6(random):
    return circle(1.0, random.uniform(35, 60)), circle(0.5, random.uniform(0.1, 25))


def triangular_6_3(random):
    return circle(1.0, random.uniform(20, 58)), circle(random.uniform(0.4, 0.9), 0)


KINDS = [
    general,
    planar_base,
    planar_platform,
    both_planar,
    almost_planar,
    crank_tips,
    paired_6_6,
    triangular_6_3,
]


def distance(pose, other):
    apart = np.abs(pose.position - other.position).max(axis=-1)
    return apart + np.abs(pose.rotation - other.rotation).max(axis=(-1, -2))


@pytest.mark.parametrize('kind', KINDS)
def test_the_pose_that_made_the_lengths_is_among_the_modes(kind):
    random = np.random.default_rng(7)
    for _ in range(enough(5, 15)):
        base, platform = kind(random)
        pose = random_pose(random, 1.2, 1.5)
        modes = assembly_modes(base, platform, lengths_at(base, platform, pose))
        assert min(distance(mode, pose) for mode in modes.poses) < 1e-7
        assert modes.complex_count == 40
        assert modes.is_complete


@pytest.mark.parametrize('kind', KINDS)
def test_every_mode_closes_the_legs_by_a_proper_rotation(kind):
    random = np.random.default_rng(8)
    for _ in range(enough(4, 10)):
        base, platform = kind(random)
        wanted = lengths_at(base, platform, random_pose(random, 1.0, 2.0))
        modes = assembly_modes(base, platform, wanted)
        for mode in modes.poses:
            error = np.abs(lengths_at(base, platform, mode) - wanted).max()
            assert error < 1e-10 * wanted.max()
            assert np.allclose(mode.rotation @ mode.rotation.T, np.eye(3), atol=1e-12)
            assert np.linalg.det(mode.rotation) > 0
        assert len(modes.poses) % 2 == 0
        assert min(modes.sigma_min) > 0


@pytest.mark.parametrize('kind', KINDS)
def test_newton_from_anywhere_finds_no_mode_that_is_not_listed(kind):
    random = np.random.default_rng(9)
    found = 0
    for _ in range(4):
        base, platform = kind(random)
        wanted = lengths_at(base, platform, random_pose(random, 1.0, 1.0))
        modes = assembly_modes(base, platform, wanted)
        solver = Newton(platform, 1.0)
        for _ in range(60):
            start = Pose(random.normal(size=3), so3.exp(random.uniform(-2, 2, 3)))
            try:
                pose = solver.solve(base, wanted, start).pose
            except NoSolution:
                continue
            found += 1
            assert min(distance(mode, pose) for mode in modes.poses) < 1e-5
    assert found > 20


def test_the_platform_of_dietmaier_has_40_real_modes():
    modes = assembly_modes(DIETMAIER_BASE, DIETMAIER_PLATFORM, DIETMAIER_LENGTHS)
    assert len(modes.poses) == 40
    assert modes.is_complete
    assert modes.infinite_count == 0


def test_a_6_3_has_at_most_16_modes():
    random = np.random.default_rng(10)
    for _ in range(10):
        base, platform = triangular_6_3(random)
        wanted = lengths_at(base, platform, random_pose(random, 1.1, 0.3))
        modes = assembly_modes(base, platform, wanted)
        assert modes.complex_count - modes.infinite_count == 16
        assert len(modes.poses) <= 16
    level = assembly_modes(circle(0.1, 50), circle(0.05, 0), np.full(6, 0.15))
    assert len(level.poses) == 16


def test_modes_of_planar_joints_are_mirrored_in_pairs():
    random = np.random.default_rng(11)
    mirror = np.diag([1.0, 1.0, -1.0])
    for _ in range(5):
        base, platform = both_planar(random)
        pose = random_pose(random, 1.2, 1.0)
        modes = assembly_modes(base, platform, lengths_at(base, platform, pose)).poses
        for mode in modes:
            image = Pose(mirror @ mode.position, mirror @ mode.rotation @ mirror)
            assert min(distance(other, image) for other in modes) < 1e-6


def test_modes_that_share_a_rotation_are_both_found():
    base, platform = circle(1.0, 50), circle(0.5, 10)
    turned = Pose(np.array([0.1, 0.05, 1.2]), so3.exp([0, 0, 0.3]))
    modes = assembly_modes(base, platform, lengths_at(base, platform, turned)).poses
    below = Pose(turned.position * [1, 1, -1], turned.rotation)
    assert min(distance(mode, turned) for mode in modes) < 1e-9
    assert min(distance(mode, below) for mode in modes) < 1e-9


def test_modes_are_sorted_from_the_highest_down():
    modes = assembly_modes(DIETMAIER_BASE, DIETMAIER_PLATFORM, DIETMAIER_LENGTHS).poses
    heights = [mode.position[2] for mode in modes]
    assert heights == sorted(heights, reverse=True)


def test_modes_move_with_the_base_and_scale_with_the_machine():
    random = np.random.default_rng(12)
    base, platform = general(random)
    wanted = lengths_at(base, platform, random_pose(random, 1.0, 1.0))
    plain = assembly_modes(base, platform, wanted)
    placed = Pose(np.array([3.0, -2.0, 5.0]), so3.exp([0.4, -0.3, 0.2]))
    moved = assembly_modes(1e-3 * placed.transform(base), 1e-3 * platform, 1e-3 * wanted)
    assert len(moved.poses) == len(plain.poses)
    for mode in plain.poses:
        expected = placed @ mode
        expected = Pose(1e-3 * expected.position, expected.rotation)
        assert min(distance(other, expected) for other in moved.poses) < 1e-7


def test_lengths_at_a_singular_pose_give_a_double_root():
    base, platform = circle(1.0, 50), circle(0.5, 10)
    quarter_turn = Pose(np.array([0.0, 0.0, 1.0]), so3.exp([0, 0, np.pi / 2]))
    modes = assembly_modes(base, platform, lengths_at(base, platform, quarter_turn))
    assert min(modes.sigma_min) < 1e-5
    assert min(distance(mode, quarter_turn) for mode in modes.poses) < 1e-4


def test_legs_that_cannot_close_have_no_modes():
    base, platform = circle(1.0, 50), circle(0.5, 10)
    modes = assembly_modes(base, platform, [9.0, 1.0, 1.0, 1.0, 1.0, 1.0])
    assert modes.poses == ()
    assert modes.complex_count == 40


@pytest.mark.parametrize('degrees', [10, 20, 30, 50])
def test_similar_hexagons_are_refused(degrees):
    with pytest.raises(NoSolution, match='joints of base and platform'):
        assembly_modes(circle(1.0, degrees), circle(0.5, degrees), np.full(6, 1.5))


def test_wrong_input_is_named():
    base, platform = circle(1.0, 50), circle(0.5, 10)
    with pytest.raises(InvalidInput, match='leg 3: length -1 m'):
        assembly_modes(base, platform, [1, 1, -1, 1, 1, 1])
    with pytest.raises(InvalidInput, match='base points have shape'):
        assembly_modes(base[:5], platform, np.ones(6))
    with pytest.raises(InvalidInput, match='leg lengths'):
        assembly_modes(base, platform, [1, 1, np.nan, 1, 1, 1])


def test_the_null_space_is_as_exact_as_the_equations_fix_it():
    random = np.random.default_rng(13)
    left, right = (np.linalg.qr(random.normal(size=(60, 60)))[0] for _ in range(2))
    singular = np.concatenate([np.geomspace(1.0, 1e-4, 50), np.zeros(10)])
    matrix = (left * singular) @ right.T
    null = _null_space(matrix.T, 40)
    assert null.shape == (60, 10)
    np.testing.assert_allclose(null.T @ null, np.eye(10), atol=1e-12)
    assert np.abs(right[:, :50].T @ null).max() < 1e-11


def test_dependent_leading_columns_are_refused():
    random = np.random.default_rng(14)
    columns = random.normal(size=(30, 8)) @ random.normal(size=(8, 20))
    with pytest.raises(NoSolution, match='finitely many'):
        _null_space(columns, 10)
