"""Who is told that the machine was cleared may ask for motion at once."""

import numpy as np
import pytest

from manipulator.errors import Refused
from manipulator.pose import Pose

pytestmark = [pytest.mark.graph, pytest.mark.real_time]

POSES = [Pose.from_xyz_rpy((0.0, 0.0, z)) for z in (0.049, 0.045)]


def test_a_goal_sent_at_once_after_the_clear_is_reached(enabled):
    for k in range(10):
        enabled.trigger('serial_bridge/stop')
        enabled.trigger('serial_bridge/clear_fault')
        enabled.go_to(POSES[k % 2])


def test_a_path_and_the_way_home_asked_for_at_once_are_driven_too(enabled):
    path = Pose(np.array([p.position for p in POSES]), np.array([p.rotation for p in POSES]))
    for ask in (lambda: enabled.follow(path), enabled.home):
        enabled.trigger('serial_bridge/stop')
        enabled.trigger('serial_bridge/clear_fault')
        ask()


def test_a_goal_sent_before_the_clear_is_refused_and_moves_nothing_afterwards(enabled):
    enabled.home()
    enabled.trigger('serial_bridge/stop')
    with pytest.raises(Refused, match='clear the stop first'):
        enabled.go_to(POSES[0])
    enabled.trigger('serial_bridge/clear_fault')
    enabled.wait('goals', lambda: enabled.motion('mode') == 'hold', 10.0)
    enabled.spin(0.2)
    assert enabled.motion('result') == 'idle'


def test_where_there_is_nothing_to_clear_it_is_said_and_motion_goes_on(enabled):
    stamp = f'{enabled.publish_goal(POSES[0]):.9f}'
    assert (
        enabled.trigger('serial_bridge/clear_fault') == 'nothing to clear: the machine is enabled'
    )

    def is_reached():
        return (enabled.motion('goal_stamp'), enabled.motion('result')) == (stamp, 'reached')

    enabled.wait('the goal', is_reached, 10.0)
