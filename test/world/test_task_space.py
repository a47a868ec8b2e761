"""Limits in task space through the whole chain."""

import re

import numpy as np
import pytest

from hexarm import machines

HALF = {'robocake': 2.0, 'arm_6r': 30.0}


@pytest.fixture
def make_boxed(make_world, tmp_path):
    """A world of a machine within a box about home, from its file."""

    def make(name):
        home = 1e3 * machines.load(name).kinematics.home.position
        ends = zip('xyz', home - HALF[name], home + HALF[name], strict=True)
        lines = [f'  {axis}_mm: [{low:.6f}, {high:.6f}]' for axis, low, high in ends]
        path = tmp_path / f'{name}.yaml'
        path.write_text('\n'.join([machines.find(name).read_text(), 'task_space:', *lines, '']))
        return make_world(str(path))

    return make


@pytest.mark.parametrize('name', HALF)
def test_goals_and_jogs_stay_within_the_box_of_the_machine_file(make_boxed, name):
    world = make_boxed(name)
    home, half = world.machine.kinematics.home, 1e-3 * HALF[name]
    refused = world.go_to(home.moved([1.1 * half, 0, 0, 0, 0, 0]))
    assert refused.result == 'refused'
    assert re.search(r'position x -?0\.0\d+ m outside \[-?0\.0\d+, 0\.0\d+\]', refused.reason)
    assert world.go_to(home.moved([0.9 * half, 0, 0, 0, 0, 0])).result == 'reached'
    since = len(world.controller.statuses)
    world.jog([0, 0.02, 0, 0, 0, 0], 2.5)
    reasons = [status.reason for _, status in world.controller.statuses[since:]]
    assert any('position y' in reason for reason in reasons)
    world.run(0.5)
    away = home.twist_to(world.controller.supervisor.executor.state.pose)[:3]
    assert np.abs(away).max() <= half + 1e-9
    assert away[1] > 0.9 * half
