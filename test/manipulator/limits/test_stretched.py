"""What the limits of a machine that stands beyond one of them say and admit."""

import numpy as np
import pytest

from hexarm.machines import load
from manipulator.errors import LimitViolated
from manipulator.framed_machine import in_frames
from manipulator.frames import Frames

MACHINE = load('robocake')
PLAIN = MACHINE.constraints
FRAMED = in_frames(MACHINE, Frames().with_pivot([0.0, 0.0, 0.02]))


def raised(height):
    """Metres from home, and the joints there."""
    pose = MACHINE.kinematics.home.moved([0.0, 0.0, height, 0.0, 0.0, 0.0])
    return pose, MACHINE.kinematics.inverse(pose)


def test_a_stretched_limit_takes_in_where_the_machine_stands_and_nothing_further_out():
    stretched = PLAIN.stretched_to(*raised(-0.0190))
    assert not PLAIN.admits(*raised(-0.0190))
    for height in (-0.0190, -0.0185, 0.0):
        assert stretched.admits(*raised(height))
    assert not stretched.admits(*raised(-0.0191))


@pytest.mark.parametrize('unstretched', [PLAIN, FRAMED.constraints])
def test_a_stretched_limit_has_the_words_of_the_limit_itself(unstretched):
    stretched = unstretched.stretched_to(*raised(-0.0190))
    for ours, theirs in zip(stretched.limits, unstretched.limits, strict=True):
        assert (ours.quantity, ours.unit, ours.owners) == (
            theirs.quantity,
            theirs.unit,
            theirs.owners,
        )


def test_what_is_refused_further_out_is_named_with_value_and_unit():
    pose, joints = raised(-0.0191)
    with pytest.raises(LimitViolated, match=r'platform height 0\.02209 m below 0\.02219'):
        PLAIN.stretched_to(*raised(-0.0190)).check(pose, joints)


def test_limits_that_a_machine_keeps_are_not_stretched():
    assert PLAIN.stretched_to(*raised(0.0)) is PLAIN
    low = PLAIN.stretched_to(*raised(-0.0190))
    changed = [
        ours.quantity
        for ours, theirs in zip(low.limits, PLAIN.limits, strict=True)
        if not (np.array_equal(ours.low, theirs.low) and np.array_equal(ours.high, theirs.high))
    ]
    assert 'platform height' in changed
    assert 'crank joint tilt' not in changed
