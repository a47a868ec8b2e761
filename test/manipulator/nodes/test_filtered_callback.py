import time
from unittest.mock import MagicMock

import pytest
from geometry_msgs.msg import PoseStamped

from manipulator.errors import InvalidInput
from manipulator.message_filter import LONGEST_REASON
from manipulator.nodes.subscriptions import FilteredCallback


def stamped(clock):
    message = PoseStamped()
    message.header.stamp.sec, message.header.stamp.nanosec = int(clock), int(clock % 1 * 1e9)
    return message


@pytest.mark.parametrize('step', [-3600.0, -5.0, 3600.0])
def test_clock_of_this_computer_that_is_set_costs_a_tenth_of_a_second(monkeypatch, step):
    monotonic = [time.monotonic()]
    clock = [time.time()]
    monkeypatch.setattr(time, 'monotonic', lambda: monotonic[0])
    monkeypatch.setattr(time, 'time', lambda: clock[0])
    taken = []
    callback = FilteredCallback(MagicMock(), 'goal_pose', taken.append)
    for k in range(60):
        if k == 30:
            clock[0] += step
        callback(stamped(clock[0]))
        monotonic[0] += 0.01
        clock[0] += 0.01
    assert len(taken) >= 50
    assert callback.refused == 60 - len(taken)


def test_endless_reason_is_cut_in_log_and_diagnostics():
    def refuse(message):
        raise InvalidInput('x' * 1_000_000)

    node = MagicMock()
    callback = FilteredCallback(node, 'goal_pose', refuse)
    callback(stamped(time.time()))
    assert len(callback.last_refusal) == LONGEST_REASON
    (text,) = node.get_logger().warning.call_args.args
    assert len(text) < 2 * LONGEST_REASON
