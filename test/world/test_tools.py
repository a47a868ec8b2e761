"""Tools of a machine file through the whole chain."""

import numpy as np
import pytest

from hexarm import machines
from manipulator.errors import InvalidInput
from manipulator.pose import Pose
from world.requests import Requests

TOOLS = """
tools:
  - {name: laser, xyz_mm: [10.0, 0.0, 30.0], rpy_deg: [0.0, 90.0, 0.0]}
  - {name: probe, xyz_mm: [0.0, -5.0, 20.0]}
"""
QUIET = 2.0
"""Counts: roundings, not motion."""


@pytest.fixture
def equipped(make_world, tmp_path):
    """A world of a machine with two tools, from its file."""

    def make(name):
        path = tmp_path / f'{name}.yaml'
        path.write_text(machines.find(name).read_text() + TOOLS)
        return make_world(str(path))

    return make


@pytest.mark.parametrize('name', ['robocake', 'arm_6r_stepper'])
def test_tools_are_changed_at_rest_and_move_along_their_own_axes(equipped, name):
    world = equipped(name)
    supervisor, ask = world.controller.supervisor, Requests(world)
    assert supervisor.machine.frames.tool == 'laser'
    home = world.machine.kinematics.home
    assert world.go_to(home.moved([0.002, 0.0, 0.001, 0.0, 0.03, 0.05])).result == 'reached'
    world.run(0.3)
    since = world.now
    for tool in ('probe', '', 'laser'):
        ask.tool(tool)
        world.run(0.3)
        assert supervisor.machine.frames.tool == tool
    with pytest.raises(InvalidInput, match='no tool is called'):
        ask.tool('saw')
    world.run(0.3)
    assert supervisor.machine.frames.tool == 'laser'
    assert world.moved(since) <= QUIET
    before = supervisor.machine.frames.platform(supervisor.executor.state.pose)
    world.jog([0.0, 0.0, 0.01, 0.0, 0.0, 0.0], 0.5, frame='tool')
    world.run(0.5)
    shift = before.twist_to(supervisor.machine.frames.platform(supervisor.executor.state.pose))
    along = (before @ Pose.from_xyz_rpy([0, 0, 0], [0, np.pi / 2, 0])).rotation[:, 2]
    length = np.linalg.norm(shift[:3])
    assert length > 2e-3
    np.testing.assert_allclose(shift[:3] / length, along, atol=2e-3)
    assert np.abs(shift[3:]).max() < 1e-4


def test_the_pivot_of_a_file_can_be_set_to_the_origin_and_nothing_moves(make_world, tmp_path):
    path = tmp_path / 'raised.yaml'
    frames = 'frames: {pivot_xyz_mm: [0.0, 0.0, 30.0]}\n'
    path.write_text(machines.find('robocake').read_text() + frames)
    world = make_world(str(path))
    world.run(0.3)
    since = world.now
    Requests(world).pivot([0.0, 0.0, 0.0])
    world.run(0.5)
    assert world.moved(since) <= QUIET
    assert world.status.mode == 'hold'
