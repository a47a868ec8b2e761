"""What the page is told and what it may ask for, as texts."""

import json

import numpy as np
import pytest

from hexarm.machines import load
from hexarm.panel.page_requests import NEEDS, PLAIN, Request, request_of
from hexarm.panel.page_state import CAN, STEPS, Controls, machine_text, nodes_text, state_text
from hexarm.panel.view import NodeReport, Stance, View
from manipulator.errors import InvalidInput
from manipulator.pose import Pose
from manipulator.states import MachineState

ROBOCAKE = load('robocake')
HOME, JOINTS = ROBOCAKE.kinematics.home, np.zeros(6)


def state(**known):
    return json.loads(state_text(View(**known), Controls.at(HOME), ''))['state']


@pytest.mark.parametrize('machine_state', list(MachineState))
def test_in_every_state_a_user_is_offered_what_has_an_effect(machine_state):
    shown = state(machine_state=str(machine_state))
    known = {*PLAIN, *NEEDS}
    assert set(shown['can']) <= known
    step = shown['step']
    assert bool(step['text']) == (machine_state != MachineState.ENABLED)
    assert step['action'] is None or step['action'] in shown['can']
    assert set(CAN) | {MachineState.DISCONNECTED, MachineState.BOOTING} == set(MachineState)
    assert set(MachineState) - {MachineState.ENABLED} <= set(STEPS)


def test_braking_is_offered_while_something_moves_and_saving_while_the_pose_is_known():
    assert 'brake' not in state(machine_state='enabled', mode='hold')['can']
    moving = state(
        machine_state='enabled',
        mode='move',
        measured=Stance(HOME, JOINTS),
        saved={'up': None},
    )
    assert {'brake', 'save'} <= set(moving['can'])
    assert moving['saved'] == ['up']


def test_poses_are_in_metres_and_radians_and_errors_are_between_them():
    at = Pose.from_xyz_rpy((0.01, 0.0, 0.045), (0.0, 0.0, 0.2))
    joints = np.arange(6.0)
    shown = state(measured=Stance(at, joints), commanded=Stance(HOME, joints))
    assert shown['pose'] == pytest.approx([0.01, 0, 0.045, 0, 0, 0.2])
    assert shown['errors'][1] == pytest.approx(0.2)
    assert shown['joint_goal'] == joints.tolist()


def test_a_hand_moves_one_coordinate_and_the_others_stay():
    controls = Controls.at(HOME)
    pose = controls.move(5, 0.1)
    assert pose.rpy == pytest.approx([0, 0, 0.1])
    assert pose.position == pytest.approx(HOME.position)
    controls.show_reach(pose, np.full((6, 2), [-0.01, 0.02]), '')
    assert controls.ranges[5] == pytest.approx([0.09, 0.12])


@pytest.mark.parametrize('name', ['robocake', 'arm_6r', 'stack_6_6'])
def test_a_page_receives_the_joints_and_finite_ranges(name):
    machine = load(name)
    words = json.loads(machine_text(machine, 'label', has_gripper=False))['machine']
    assert [joint['name'] for joint in words['joints']] == list(machine.kinematics.joint_names)
    assert all(joint['low'] < joint['high'] for joint in words['joints'])
    assert np.isfinite(words['bounds']).all()


def test_the_tool_that_trajectory_reports_is_shown_and_before_that_the_files():
    assert state()['tool'] == ''
    report = NodeReport('trajectory', 0, 'running', {'tool': 'probe'}, 0.1)
    assert state(nodes=(report,))['tool'] == 'probe'
    assert request_of('{"do": "tool", "name": ""}') == Request('tool')


def test_a_silent_node_is_an_error():
    silent = NodeReport('ik', 0, 'running', {}, 5.0)
    (shown,) = json.loads(nodes_text((silent,)))['nodes']
    assert (shown['level'], shown['message']) == (2, 'silent for 5 s')


def test_requests_are_read():
    assert request_of('{"want": "state"}') == 'state'
    assert request_of('{"do": "stop"}') == Request('stop')
    assert request_of('{"do": "goal", "axis": 2, "value": 0.04}') == Request('goal', 2, 0.04)
    assert request_of('{"do": "save", "name": "up"}') == Request('save', name='up')


@pytest.mark.parametrize(
    'text',
    [
        b'{}',
        '{}',
        'x',
        '[]',
        '{"do": "explode"}',
        '{"do": ["stop"]}',
        '{"do": "goal", "axis": 6, "value": 0}',
        '{"do": "goal", "axis": true, "value": 0}',
        '{"do": "goal", "axis": 1, "value": NaN}',
        '{"do": "joint", "value": 1}',
        '{"do": "save", "name": 3}',
        '{"want": "everything"}',
        '[' * 900,
        '{"do": "save", "name": "' + 'x' * 1000 + '"}',
    ],
)
def test_malformed_requests_are_refused(text):
    with pytest.raises(InvalidInput):
        request_of(text)
