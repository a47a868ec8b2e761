"""How a violation of a limit reads."""

import pytest

from hexarm.machines import load
from manipulator.errors import LimitViolated
from manipulator.limits.limit import Violation
from manipulator.pose import Pose


@pytest.mark.parametrize(
    ('value', 'low', 'high', 'words'),
    [
        (3.92, 0.5236, 3.665, '3.92 rad outside [0.5236, 3.665]'),
        (-3.1415927, -3.1415926, 3.1415926, '-3.1415927 rad outside [-3.1415926, 3.1415926]'),
        (3.66519, 0.5236, 3.66518, '3.66519 rad outside [0.5236, 3.66518]'),
        (0.1, 0.1, 1.0, '0.1 rad outside [0.1, 1]'),  # by less than a double shows
        (0.0211, 0.0234, float('inf'), '0.0211 rad below 0.0234'),
        (0.5, float('-inf'), 0.25, '0.5 rad above 0.25'),
    ],
)
def test_the_value_reads_differently_from_the_bound_that_it_is_beyond(value, low, high, words):
    violation = Violation('joint angle', 'rad', 'joint 4', value, low, high)
    assert str(violation) == f'joint 4: joint angle {words}'


def test_of_many_violations_the_farthest_are_named_and_the_others_counted():
    machine = load('stack_6_6')
    pose = Pose.from_xyz_rpy((0.2, 0.0, 1.0), (0.0, 0.0, 0.0))
    joints = machine.kinematics.inverse(pose)
    found = machine.constraints.violations(pose, joints)
    worst = max((v for v in found if v.quantity == 'leg length'), key=lambda v: v.excess)
    with pytest.raises(LimitViolated) as caught:
        machine.constraints.check(pose, joints)
    texts = str(caught.value).split('; ')
    assert texts[0] == str(worst)
    assert (len(texts), texts[-1]) == (4, f'and {len(found) - 3} more')
