"""Surroundings of a machine file through the whole chain."""

import re

import numpy as np

from arm_control.bodies import line_of
from hexarm import machines

TABLE = 0.35
"""Metres."""


def test_the_stick_cannot_drive_the_tool_below_the_table(make_world, tmp_path):
    path = tmp_path / 'arm.yaml'
    corners = f'[[-900, 200, 0], [900, 900, {1e3 * TABLE}]]'
    more = f'surroundings: {{floor_mm: 0, boxes: [{{name: table, corners_mm: {corners}}}]}}\n'
    path.write_text(machines.find('arm_6r').read_text() + more)
    world = make_world(str(path))
    home = world.machine.kinematics.home
    depth = float(home.position[2]) - TABLE
    refused = world.go_to(home.moved([0, 0, -depth - 0.02, 0, 0, 0]))
    assert refused.result == 'refused'
    assert re.search('tool meets the box table by 20 mm', refused.reason)
    since = len(world.controller.statuses)
    world.jog([0, 0, -0.2, 0, 0, 0], 4.0)
    reasons = [status.reason for _, status in world.controller.statuses[since:]]
    assert any('tool meets the box table' in reason for reason in reasons)
    world.run(0.5)
    executor = world.controller.supervisor.executor
    tool = line_of(world.machine.kinematics, np.asarray(executor.joints))[-1]
    assert TABLE - 1e-9 <= tool[2] < TABLE + 2e-3
