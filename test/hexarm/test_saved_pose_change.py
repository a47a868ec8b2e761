"""A client that saves or deletes a pose: which message on saved_pose_status is its answer."""

from unittest.mock import MagicMock

import pytest

pytest.importorskip('rclpy')

from std_msgs.msg import String

from hexarm.robot_client import RobotClient
from manipulator.errors import Refused

OLD = (('saved_poses', 'old'), None, None, ('saved_pose_status', 'up: deleted'))
"""What a late subscriber receives, the status a little after the text."""


class Changing(RobotClient):
    """Receives one message (topic, text) at each wait; `answers` once it has sent a name."""

    def __init__(self, *answers):
        super().__init__('simulated', lambda: None)
        self.messages = list(OLD)
        changes = MagicMock()
        changes.publish.side_effect = lambda message: self.messages.extend(answers)
        self.node.create_publisher = MagicMock(return_value=changes)

    def spin(self, seconds):
        message = self.messages.pop(0) if self.messages else None
        if message is not None:
            topic, text = message
            self._note(topic, String(data=text))


def test_an_older_outcome_that_comes_late_is_not_the_answer():
    answer = 'saved_pose_status', 'up: refused: no pose'
    with Changing(answer) as user, pytest.raises(Refused, match='no pose'):
        user.change_saved_pose('delete_pose', 'up')


@pytest.mark.parametrize('other', ['', 'upper: saved'])
def test_the_outcome_of_another_name_is_not_the_answer(other):
    answers = (('saved_pose_status', other), ('saved_pose_status', 'up: refused: no pose'))
    with Changing(*answers) as user, pytest.raises(Refused, match='no pose'):
        user.change_saved_pose('save_pose', 'up')


def test_the_name_of_a_new_pose_is_in_the_answer_and_the_pose_in_the_text():
    answers = (('saved_pose_status', ''), ('saved_pose_status', 'pose_7: saved'), None, None)
    with Changing(*answers, ('saved_poses', 'new')) as user:
        assert user.change_saved_pose('save_pose', '') == 'pose_7'
        assert user.saved_poses() == 'new'
