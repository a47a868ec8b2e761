"""Platforms on struts that slide on rails: by definition, and the files that describe them."""

from pathlib import Path

import numpy as np
import pytest

from hexapod_control import load
from hexapod_control.rails import RailPlatform, RailsConfig
from hexapod_control.workspace import sample
from hexarm.machine_check import problems_of
from hexarm.machines import load as shipped_machine
from leg_kinds import RAILS
from manipulator.analysis.nearest import nearest_reachable
from manipulator.config import build, parse_yaml
from manipulator.errors import ConfigError, NoSolution, Unreachable
from manipulator.limits.machine_limits import JointRange
from manipulator.machine import MachineFile
from manipulator.pose import Pose

LEVEL = {
    'rail_points_mm': [[400.0, 200.0, 0.0], [-400.0, 200.0, 0.0]] * 3,
    'rail_directions': [[-1.0, 0.0, 0.0], [2.0, 0.0, 0.0]] * 3,
    'platform_joints_mm': [[50.0, 200.0, 0.0], [-50.0, 200.0, 0.0]] * 3,
    'rod_length_mm': 400.0,
    'home_height_mm': 302.0,
}
"""Legs 1, 3, 5 run towards −x, the others towards +x, each below its platform joint."""


def turned_by_thirds(geometry):
    """The same pairs of legs at 0°, 120° and 240°, so that the machine is no singular one."""
    found = dict(geometry)
    for key in ('rail_points_mm', 'rail_directions', 'platform_joints_mm'):
        points = np.array(geometry[key])
        for pair in range(3):
            c, s = np.cos(2 * np.pi * pair / 3), np.sin(2 * np.pi * pair / 3)
            legs = slice(2 * pair, 2 * pair + 2)
            points[legs] = points[legs] @ np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
        found[key] = points.tolist()
    return found


def level(**changes):
    geometry = build(RailsConfig, turned_by_thirds(LEVEL | changes)).geometry()
    return RailPlatform(geometry, 0.2, 0.1, (-0.1, 0.4))


@pytest.fixture(scope='module')
def rails():
    return load.hexapod(build(MachineFile, parse_yaml(Path(RAILS).read_text())))


@pytest.mark.parametrize(('height', 'back'), [(302, 262.29), (377, 133.68), (227, 329.34)])
def test_a_strut_of_400_mm_stands_back_by_the_root_of_its_square_less_the_height_squared(
    height, back
):
    """Each platform joint is at 350 mm from its rail's point, along the rail."""
    pose = Pose.from_xyz_rpy((0.0, 0.0, 1e-3 * height))
    assert (400**2 - height**2) ** 0.5 == pytest.approx(back, abs=0.01)
    for side, sign in (('behind', -1.0), ('ahead', 1.0)):
        joints = 1e3 * level(carriages=side).inverse(pose)
        np.testing.assert_allclose(joints, 350.0 + sign * back, atol=0.01)


def test_struts_keep_their_length_over_the_whole_workspace(rails):
    """From the numbers of the file alone."""
    g = {k: np.array(v) for k, v in parse_yaml(Path(RAILS).read_text())['geometry'].items()}
    poses = sample(rails, 300, np.random.default_rng(1))
    for pose, joints in zip(poses, rails.kinematics.inverse(poses), strict=True):
        lower = g['rail_points_mm'] + 1e3 * joints[:, None] * g['rail_directions']
        upper = 1e3 * pose.transform(1e-3 * g['platform_joints_mm'])
        along = ((upper - lower) * g['rail_directions']).sum(axis=1)
        np.testing.assert_allclose(np.linalg.norm(upper - lower, axis=1), 400.0, atol=2e-5)
        assert ((along > 0) == (g['carriages'] == 'behind')).all()


def test_carriages_stay_on_the_side_that_they_are_near_unless_both_nearly_meet(rails):
    kinematics, home = rails.kinematics, rails.kinematics.home
    near, far = kinematics.inverse_all(home)[[0, -1]]
    wanted = np.where([True, False] * 3, near, far)
    np.testing.assert_allclose(kinematics.inverse(home, wanted + 0.01), wanted, atol=1e-12)
    middle = (near + far) / 2
    nudged = middle + 0.04 * 0.4 * np.sign(far - near)
    np.testing.assert_allclose(kinematics.inverse(home, nudged), near, atol=1e-12)


def test_a_strut_that_does_not_reach_its_rail_is_named_with_the_length_that_it_needs():
    """Only leg 4 has its platform joint lowered by less than what is missing."""
    lowered = [
        [x, y, -60.0 * (leg != 3)] for leg, (x, y, _) in enumerate(LEVEL['platform_joints_mm'])
    ]
    machine = level(platform_joints_mm=lowered)
    words = r'leg 4: rod too short by 50(\.0*)? mm \(400 mm, needs 450 mm or more\)'
    with pytest.raises(Unreachable, match=words) as error:
        machine.inverse(Pose.from_xyz_rpy((0.0, 0.0, 0.45)))
    assert error.value.leg == 4


def test_a_strut_square_to_its_rail_has_no_rates():
    machine = level()
    pose = Pose.from_xyz_rpy((0.0, 0.0, 0.4 - 1e-14))
    with pytest.raises(NoSolution, match='a rod is square to its rail'):
        machine.joint_rates(pose, machine.inverse(pose))


def test_joint_rates_are_how_carriages_follow_the_pose(rails):
    kinematics, step = rails.kinematics, 1e-7
    poses = sample(rails, 50, np.random.default_rng(3))
    rates = kinematics.joint_rates(poses, kinematics.inverse(poses))
    for axis, twist in enumerate(np.eye(6) * step):
        ahead, behind = (kinematics.inverse(poses.moved(t)) for t in (twist, -twist))
        np.testing.assert_allclose(
            rates[..., axis], (ahead - behind) / (2 * step), rtol=1e-5, atol=1e-6
        )


def test_rails_are_drawn_from_end_to_end_of_their_range(rails):
    kinematics = rails.kinematics
    strokes = kinematics.skeleton(kinematics.home, kinematics.inverse(kinematics.home))
    drawn = [stroke for stroke in strokes if stroke.part == 'body']
    assert [stroke.part for stroke in strokes].count('rod') == 6
    for leg, stroke in enumerate(drawn):
        expected = kinematics.geometry.rail_points[leg] + np.outer(
            [0.0, 0.2], kinematics.geometry.directions[leg]
        )
        np.testing.assert_allclose(stroke.points, expected, atol=1e-12)


def test_limits_name_the_carriage_and_the_cone(rails):
    (limit,) = (x for x in rails.constraints.limits if isinstance(x, JointRange))
    assert (limit.quantity, limit.unit) == ('carriage position', 'm')
    low = rails.kinematics.home.moved([0.0, 0.0, -0.14, 0.0, 0.0, 0.0])
    found = rails.constraints.violations(low, rails.kinematics.inverse(low))
    assert 'leg 1: carriage position -0.0' in str(found[0])


@pytest.mark.parametrize(
    ('changes', 'words'),
    [
        (
            {'rail_directions': [[0.0, 0.0, 0.0]] * 6},
            r'leg 6: rail_directions\[5\] has no direction',
        ),
        ({'carriages': 'behnd'}, r"carriages: 'behnd' is not one of .*, did you mean 'behind'"),
        ({'carriages': ['ahead'] * 5}, r'carriages: has 5 entries, needs 6'),
        ({'rod_length_mm': -4.0}, r'rod_length_mm: -4 outside \[0.001, 1e\+06\]'),
        ({'home_height_mm': 500.0}, r'the model does not close at home: leg \d: rod too short by'),
        ({'rail_points': 1}, r"rail_points: unknown key, did you mean 'rail_points_mm'"),
    ],
)
def test_what_is_wrong_with_the_geometry_is_named(changes, words):
    content = parse_yaml(Path(RAILS).read_text())
    content['geometry'] |= changes
    with pytest.raises(ConfigError, match=words):
        load.hexapod(build(MachineFile, content))


def test_rails_that_never_fix_a_pose_are_refused():
    content = parse_yaml(Path(RAILS).read_text())
    for key in ('rail_points_mm', 'rail_directions', 'platform_joints_mm'):
        content['geometry'][key] = LEVEL[key]
    with pytest.raises(ConfigError, match='no leg lengths fix a pose'):
        load.hexapod(build(MachineFile, content))


def test_servos_in_degrees_are_refused():
    text = Path(RAILS).read_text()
    for old, new in (
        ('centre_mm', 'centre_deg'),
        ('us_per_mm', 'us_per_deg'),
        ('speed_mm_s: 1000', 'speed_deg_s: 1000'),
        ('park_mm', 'park_deg'),
    ):
        assert old in text
        text = text.replace(old, new)
    assert any(p.startswith('servos.joints: in degrees') for p in problems_of(text))
    assert problems_of(Path(RAILS).read_text()) == []


def test_carriages_on_the_wrong_side_are_named_with_what_to_write():
    content = parse_yaml(Path(RAILS).read_text())
    content['geometry']['carriages'] = ['behind', 'behind', *['behind', 'ahead'] * 2]
    with pytest.raises(ConfigError) as error:
        load.hexapod(build(MachineFile, content))
    (problem,) = error.value.problems
    assert problem.startswith('limits: home has carriage position')
    assert 'on leg 2, outside [0, 200] mm' in problem
    sides = 'behind, ahead, behind, ahead, behind, ahead'
    assert problem.endswith(
        f"on their joints' other side they are at 100 mm: write carriages: [{sides}]"
    )


def test_each_rail_may_have_its_own_range():
    content = parse_yaml(Path(RAILS).read_text())
    content['limits']['rail_range_mm'] = [[0.0, 200.0]] * 5 + [[50.0, 150.0]]
    machine = load.hexapod(build(MachineFile, content))
    np.testing.assert_allclose(machine.joint_ranges, [[0.0] * 5 + [0.05], [0.2] * 5 + [0.15]])
    np.testing.assert_allclose(
        np.ptp(machine.kinematics.rail_ends, axis=1)[5],
        0.1 * np.abs(machine.kinematics.geometry.directions[5]),
        atol=1e-12,
    )


def test_no_admitted_neighbour_of_the_nearest_reachable_pose_is_nearer(rails):
    """Limits that this kind of legs does not have, as a longest rod, leave the search its room."""
    kinematics, length = rails.kinematics, rails.kinematics.characteristic_length
    target = kinematics.home.moved([0.3, 0.1, 0.0, 0.0, 0.2, 0.1])
    found = nearest_reachable(rails, target)
    scale = np.array([1.0] * 3 + [length] * 3)
    steps = np.random.default_rng(2).standard_normal((2000, 6)) * 1e-3 * length / scale
    near = found.pose.moved(steps)
    joints = kinematics.inverse_or_nan(near)
    inside = np.isfinite(joints).all(axis=1)
    inside[inside] = rails.constraints.admits(near[inside], joints[inside])
    assert inside.any()
    distances = np.linalg.norm(near[inside].twist_to(target) * scale, axis=1)
    assert distances.min() > found.distance - 1e-4 * length


def test_the_shipped_machine_stands_as_published_with_its_carriages_in_mid_travel():
    """By the published constants: pairs at 0°, 120°, 240° below pairs at 60°, 180°, 300°."""
    kinematics = shipped_machine('linear_rails').kinematics
    g, home = kinematics.geometry, kinematics.home
    radii = [np.hypot(60.968, 16.0), np.hypot(36.742, 7.5)]
    for points, radius in zip((g.rail_points, g.platform_points), radii, strict=True):
        np.testing.assert_allclose(1e3 * np.hypot(*points[:, :2].T), radius, atol=1e-3)
    lower = kinematics.base_points(kinematics.inverse(home))
    upper = home.transform(g.platform_points)
    np.testing.assert_allclose(1e3 * lower[:, 2], 78.383 + 50.0, atol=1e-3)
    np.testing.assert_allclose(1e3 * np.linalg.norm(upper - lower, axis=1), 150.362, atol=1e-6)
    nearest = np.linalg.norm((upper[:, None] - lower)[..., :2], axis=-1).argmin(axis=1)
    np.testing.assert_array_equal(nearest, np.arange(6))
