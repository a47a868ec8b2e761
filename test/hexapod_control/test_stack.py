"""Platforms on platforms."""

import numpy as np
import pytest

from hexapod_control import load
from hexapod_control.stacks.stack import Stack
from hexapod_control.workspace import sample
from manipulator.config import build
from manipulator.errors import ConfigError, InvalidInput, NoSolution, Unreachable
from manipulator.machine import MachineFile
from manipulator.pose import Pose
from sampling import enough

PLATE = Pose.from_xyz_rpy((0.0, 0.0, 0.01), (0.0, 0.0, 0.5))
TOOL = Pose.from_xyz_rpy((0.01, 0.0, 0.03))


def matrix(pose):
    whole = np.eye(4)
    whole[:3, :3], whole[:3, 3] = pose.rotation, pose.position
    return whole


@pytest.fixture(scope='module')
def stewart(stewart_content):
    return load.hexapod(build(MachineFile, stewart_content('stewart_6_6')))


@pytest.fixture(scope='module')
def twins(stewart):
    return Stack((stewart, stewart), (Pose.identity(), Pose.identity()))


@pytest.fixture(scope='module')
def mixed(stewart, robocake, stewart_content):
    lower = load.hexapod(build(MachineFile, stewart_content('stewart_6_3')))
    return Stack((lower, robocake, stewart), (PLATE, Pose.identity(), TOOL))


@pytest.fixture(params=['twins', 'mixed'])
def stack(request):
    return request.getfixturevalue(request.param)


def reachable_ends(stack, count):
    """Ends of stacks whose sections are anywhere in their own workspaces."""
    rows = [sample(m, count, np.random.default_rng(k)) for k, m in enumerate(stack.sections)]
    return [
        (stack.end_of([poses[k] for poses in rows]), [p[k] for p in rows]) for k in range(count)
    ]


def test_end_is_the_product_of_homogeneous_matrices(mixed):
    for end, sections in reachable_ends(mixed, 5):
        product = np.eye(4)
        for pose, transform in zip(sections, mixed.transforms, strict=True):
            product = product @ matrix(pose) @ matrix(transform)
        np.testing.assert_allclose(matrix(end), product, atol=1e-14)


def test_forward_of_all_joints_finds_every_section(stack):
    for end, sections in reachable_ends(stack, enough(5, 10)):
        joints = [m.kinematics.inverse(p) for m, p in zip(stack.sections, sections, strict=True)]
        for near in (None, sections):
            found = stack.forward(np.array(joints), near)
            assert np.abs(end.twist_to(found.end)).max() < 1e-8
            for pose, wanted in zip(found.sections, sections, strict=True):
                assert np.abs(wanted.twist_to(pose)).max() < 1e-8


def test_inverse_reaches_the_end_within_every_sections_limits_and_nearer_to_home(stack):
    reached, count = 0, enough(6, 12)
    for end, sections in reachable_ends(stack, count):
        try:
            found = stack.inverse(end)
        except Unreachable:
            continue
        reached += 1
        assert np.abs(end.twist_to(stack.forward(found.joints).end)).max() < 1e-8
        for machine, pose, joints in zip(
            stack.sections, found.sections, found.joints, strict=True
        ):
            machine.constraints.check(pose, joints)
        assert found.distance <= stack.distance(sections) * 1.0001
    assert reached >= count - 1


def test_home_is_where_all_sections_are_at_home(stack):
    found = stack.inverse(stack.home)
    assert found.distance < 1e-9
    for machine, pose in zip(stack.sections, found.sections, strict=True):
        assert np.abs(machine.kinematics.home.twist_to(pose)).max() < 1e-9


def test_equal_sections_share_a_lift_equally(twins):
    found = twins.inverse(twins.home.moved([0.0, 0.0, 0.03, 0.0, 0.0, 0.0]))
    lifts = [
        p.position[2] - m.kinematics.home.position[2]
        for m, p in zip(twins.sections, found.sections, strict=True)
    ]
    assert lifts == pytest.approx([0.015, 0.015], abs=1e-9)


def test_sections_share_a_lift_as_the_squares_of_their_ranges(stewart, robocake):
    stack = Stack((stewart, robocake), (Pose.identity(), Pose.identity()))
    found = stack.inverse(stack.home.moved([0.0, 0.0, 0.02, 0.0, 0.0, 0.0]))
    lifts = [
        p.position[2] - m.kinematics.home.position[2]
        for m, p in zip(stack.sections, found.sections, strict=True)
    ]
    assert lifts[0] / lifts[1] == pytest.approx((stack.ranges[0, 2] / stack.ranges[1, 2]) ** 2)


@pytest.mark.parametrize('twist', [(0.03, -0.02, 0.02, 0.3, -0.2, 0.4), (0, 0, 0, 0.7, 0, 0)])
def test_no_other_way_to_the_same_end_is_nearer_to_home(stack, twist):
    end = stack.home.moved(twist)
    found = stack.inverse(end)
    generator = np.random.default_rng(3)
    for size in (1e-3, 1e-2, 1e-1):
        for _ in range(20):
            others, base = [], Pose.identity()
            for i, pose in enumerate(found.sections[:-1]):
                moved = pose.moved(size * stack.ranges[i] * generator.standard_normal(6))
                others.append(moved)
                base = base @ moved @ stack.transforms[i]
            others.append(base.inverse() @ end @ stack.transforms[-1].inverse())
            assert stack.distance(others) > found.distance


def test_a_tilt_beyond_one_section_is_in_reach_of_two(stewart, twins):
    tilt = np.array([0.0, 0.0, 0.0, 0.85, 0.0, 0.0])
    kinematics = stewart.kinematics
    alone = kinematics.home.moved(tilt)
    assert not stewart.constraints.admits(alone, kinematics.inverse(alone))
    assert twins.inverse(twins.home.moved(tilt)).distance > 0.0


@pytest.mark.parametrize('metres', [0.12, 1.0])
def test_a_lift_beyond_all_strokes_is_refused_with_section_and_leg(twins, metres):
    with pytest.raises(Unreachable, match=r'section 1: leg \d: leg length .* outside') as caught:
        twins.inverse(twins.home.moved([0.0, 0.0, metres, 0.0, 0.0, 0.0]))
    assert caught.value.leg in range(1, 7)


def test_joints_that_no_section_can_have_are_refused_with_the_section(twins):
    joints = np.full((2, 6), 0.19)
    joints[1, 2] = np.nan
    with pytest.raises(NoSolution, match='section 2: joints are not finite'):
        twins.forward(joints)
    with pytest.raises(InvalidInput, match='for 2 sections'):
        twins.forward(joints[:1])


def test_a_stack_needs_sections_and_as_many_transforms(stewart):
    for sections, transforms in (((), ()), ((stewart,), ())):
        with pytest.raises(ConfigError, match='transforms of a stack'):
            Stack(sections, transforms)
