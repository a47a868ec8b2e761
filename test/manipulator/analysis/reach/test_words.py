from manipulator.analysis.reach import explained
from manipulator.pose import Pose


def test_a_refusal_names_the_limit_and_a_pose_within_reach(robocake):
    words = explained(robocake, Pose.from_xyz_rpy([0, 0, 0.075]))
    reason, nearest = words.split('; nearest reachable: ')
    assert 'rod too' in reason
    assert nearest.endswith('z 59.100 mm  roll 0.00  pitch 0.00  yaw 0.00°')


def test_a_reachable_pose_needs_no_words(robocake):
    assert explained(robocake, robocake.kinematics.home) == ''
