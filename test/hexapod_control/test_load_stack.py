"""Machine files of kind `stack`: what they make, and what is wrong with them."""

import copy
from pathlib import Path

import numpy as np
import pytest

from hexapod_control.stacks.load import stack
from hexarm.machine_check import report_of
from hexarm.machines import content_of
from manipulator.config import build, parse_yaml
from manipulator.errors import ConfigError, Refused
from manipulator.machine import MachineFile
from manipulator.planning.joint_move import plan_joint_move
from manipulator.pose import Pose
from manipulator.teleop.jogger import JogMotion

SHIPPED = Path(__file__).parents[2] / 'config' / 'stack_6_6.yaml'
CONTENT = content_of(SHIPPED)
ROTARY = parse_yaml(SHIPPED.with_name('robocake.yaml').read_text())


def problems_of(change):
    content = copy.deepcopy(CONTENT)
    change(content['geometry'])
    return list(report_of(content).problems)


def rotary_section():
    return {key: ROTARY[key] for key in ('kind', 'geometry', 'limits')}


def test_shipped_stack_has_18_joints_named_by_section_and_no_problems():
    report = report_of(CONTENT)
    assert report.problems == report.warnings == ()
    names = report.machine.kinematics.joint_names
    assert len(names) == 18
    assert (names[0], names[7], names[17]) == (
        'section_1_leg_1', 'section_2_leg_2', 'section_3_leg_6',
    )  # fmt: skip


def test_home_is_the_sum_of_the_sections_heights_and_of_what_lies_between():
    home = stack(build(MachineFile, CONTENT)).kinematics.home
    heights = [s['geometry']['home_height_mm'] for s in CONTENT['geometry']['sections']]
    offsets = [4.0, 4.0]
    assert home.position == pytest.approx([0, 0, 1e-3 * (sum(heights) + sum(offsets))])


def test_the_transform_to_the_next_section_turns_it():
    content = copy.deepcopy(CONTENT)
    content['geometry']['sections'][0]['next'] = {'rpy_deg': [0.0, 0.0, 30.0]}
    home = stack(build(MachineFile, content)).kinematics.home
    assert home.rpy == pytest.approx([0.0, 0.0, np.radians(30.0)])


@pytest.mark.parametrize(
    ('change', 'problem'),
    [
        (lambda g: g.update(sections=[]), 'geometry: sections: 0 sections, a stack has 2 to 6'),
        (lambda g: g.update(sections=g['sections'][:1]), '1 section, a stack has 2 to 6'),
        (lambda g: g.update(sections=20 * g['sections'][:1]), '20 sections, a stack has 2'),
        (lambda g: g.pop('sections'), 'geometry.sections: missing'),
        (lambda g: g.update(sections='two'), 'geometry.sections: holds'),
        (
            lambda g: g['sections'][1].update(kind='octopod'),
            "geometry.sections[1].kind: 'octopod' is not one of",
        ),
        (
            lambda g: g['sections'][1].update(kind='serial_arm'),
            "geometry.sections[1].kind: 'serial_arm' is not one of",
        ),
        (
            lambda g: g['sections'][1].update(kind='stack'),
            "geometry.sections[1].kind: 'stack' is not one of",
        ),
        (
            lambda g: g['sections'][2]['geometry'].pop('home_height_mm'),
            'geometry.sections[2].geometry.home_height_mm: missing',
        ),
        (
            lambda g: g['sections'][2]['limits'].update(stroke_range_mm=[142.0, 180.0]),
            'geometry.sections[2].limits: home has leg length 190 mm on all legs',
        ),
        (
            lambda g: g['sections'][0].update(next={'xyz_mm': [0.0, 0.0]}),
            'geometry.sections[0].next.xyz_mm: has 2 entries, needs 3',
        ),
        (
            lambda g: g['sections'].__setitem__(1, rotary_section()),
            "geometry.sections[1]: its joints are in rad, those of sections[0] in m; all",
        ),
    ],
)  # fmt: skip
def test_what_does_not_fit_is_named_with_its_section(change, problem):
    assert any(problem in found for found in problems_of(change)), problems_of(change)


def test_speeds_of_six_joints_alone_are_named():
    content = copy.deepcopy(CONTENT)
    content['motion']['joint_speed_mm_s'] = [20.0] * 6
    with pytest.raises(ConfigError, match='joint_speed_mm_s: has 6 entries, a stack of 18 joints'):
        stack(build(MachineFile, content))


def test_a_park_position_that_is_not_the_rules_is_named():
    content = copy.deepcopy(CONTENT)
    content['servos']['park_mm'] = [195.0] * 6 + [190.0] * 6 + [185.0] * 6
    (problem,) = report_of(content).problems
    assert problem.startswith('servos.park_mm: not where the sections share the pose of the end')


def test_task_space_limits_are_those_of_the_end():
    content = copy.deepcopy(CONTENT)
    content['task_space'] = {'z_mm': [500.0, 600.0], 'turn_deg': [-20.0, 20.0]}
    machine = report_of(content).machine
    for twist, quantity in (((0, 0, 0.05, 0, 0, 0), 'position z'), ((0, 0, 0, 0, 0, 0.5), 'turn')):
        pose = machine.kinematics.home.moved(twist)
        joints = machine.kinematics.inverse(pose)
        assert not machine.constraints.admits(pose, joints)
        (violation,) = machine.constraints.violations(pose, joints)
        assert violation.quantity == quantity


def test_a_jog_keeps_every_limit_stops_at_one_and_comes_back():
    machine = report_of(CONTENT).machine
    kinematics, jogger = machine.kinematics, machine.make_jogger(machine)
    near = kinematics.home.moved([0.0, 0.0, 0.13, 0.0, 0.0, 0.0])
    motion = JogMotion.at_rest(near, kinematics.inverse(near))
    twist, bounds = np.array([0.01, 0.0, 0.02, 0.0, 0.0, 0.1]), machine.motion.joint
    for _ in range(300):
        before = motion
        motion = jogger.step(motion, twist, 0.01)
        rates = (motion.joints - before.joints) / 0.01
        assert machine.constraints.admits(motion.pose, motion.joints)
        assert np.abs(rates).max() <= bounds.speed * 1.0001
        assert np.abs(rates - before.rates).max() <= bounds.acceleration * 0.01 * 1.0001
    assert motion.is_at_rest
    assert 'section' in motion.held_by
    assert jogger.step(motion, -twist, 0.01).scale == 1.0


def test_the_values_of_limits_follow_the_joints_where_they_are_not_the_rules():
    machine = report_of(CONTENT).machine
    joints = np.full(18, 0.19)
    joints[:6], joints[12:] = 0.2, 0.18
    end = machine.kinematics.forward(joints).pose
    names = machine.constraints.names
    lengths = [k for k, (quantity, _, _) in enumerate(names) if quantity == 'leg length']
    np.testing.assert_allclose(machine.constraints.values(end, joints)[lengths], joints)
    assert names[lengths[6]][1] == 'section 2 leg 1'
    far = Pose(end.position + 1.0, np.eye(3))
    assert not machine.constraints.admits(far, machine.kinematics.inverse_or_nan(far))


def test_a_row_of_poses_is_solved_as_each_alone_until_one_is_out_of_reach():
    machine = report_of(CONTENT).machine
    kinematics = machine.kinematics
    steps = np.linspace(0.0, 0.6, 61)[:, None] * np.array([1.0, 0.0, 0.0, 0.0, 0.0, 0.0])
    row = kinematics.home.moved(steps)
    joints = kinematics.inverse_along(row, kinematics.inverse(kinematics.home))
    kept = machine.constraints.admits(row, joints)
    last = int(np.argmin(kept))
    assert kept[:last].all()
    assert last > 20
    assert not kept[last:].any()
    np.testing.assert_allclose(joints[:20], kinematics.inverse(row[:20]), atol=1e-5)


def test_a_stack_has_no_joint_move():
    machine = report_of(CONTENT).machine
    kinematics = machine.kinematics
    begin = kinematics.inverse(kinematics.home)
    with pytest.raises(Refused, match='18 joints cannot be commanded one by one'):
        plan_joint_move(machine, kinematics.home, begin, begin + 0.001)
