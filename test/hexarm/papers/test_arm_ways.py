"""Three ways to the arm's inverse give the same joints; three projections give nine."""

import numpy as np
import pytest

from hexarm.papers.arm_method import at_false_singularity
from hexarm.papers.arm_ways import Trigonometry, by_equations, by_triangles
from hexarm.papers.paper_arm import PaperArm, joint_rates, nine_projections, wrist_factors
from manipulator import rotation as so3
from manipulator.errors import NoSolution, Unreachable

ARM = PaperArm(0.3, 0.4, 0.4)


@pytest.mark.parametrize(('way', 'calls'), [(by_equations, 6), (by_triangles, 11)])
def test_joints_of_the_branch_come_back_and_every_call_counts(arm_6r, way, calls):
    joints = np.random.default_rng(5).uniform(
        [-3, -0.4, 0.4, -3, 0.3, -3], [3, 0.8, 2.0, 3, 2.6, 3], (200, 6)
    )
    for q in joints[np.sin(joints[:, 1]) + np.sin(joints[:, 1] + joints[:, 2]) > 0.1]:
        use = Trigonometry()
        rotation = arm_6r.chain.forward(q).rotation
        assert way(ARM, ARM.position(q), rotation, use) == pytest.approx(q, abs=1e-9)
        assert use.calls.total() == calls


@pytest.mark.parametrize('way', [by_equations, by_triangles])
def test_a_centre_beyond_the_arm_is_refused(way):
    with pytest.raises(Unreachable, match='beyond the arm'):
        way(ARM, np.array([0.9, 0.0, 0.3]), np.eye(3), Trigonometry())


def test_nine_projections_are_those_of_the_rotation_nearby():
    """But where a_y or s_z is about zero: there two of the four solutions are neighbours."""
    generator = np.random.default_rng(8)
    for vector in generator.uniform(-1.5, 1.5, (100, 3)):
        r = so3.exp(vector)
        nine = np.stack([r[:, 2], -r[:, 1], r[:, 0]])
        if min(abs(nine[0, 1]), abs(nine[2, 2])) < 0.05:
            continue
        other = so3.exp(vector + 0.01)
        near = np.stack([other[:, 2], -other[:, 1], other[:, 0]])
        three = np.array([nine[0, 0], nine[0, 2], nine[1, 2]])
        assert nine_projections(three, near) == pytest.approx(nine, abs=1e-9)


@pytest.mark.parametrize('three', [(0.9, 0.9, 0.0), (0.0, 0.9, 0.9), (0.0, 1.0, 0.0)])
def test_three_numbers_that_no_rotation_has_are_refused(three):
    with pytest.raises(NoSolution, match='no rotation'):
        nine_projections(np.array(three), np.eye(3))


@pytest.mark.parametrize(('axis', 'joint'), [('a_y', 0), ('s_z', 5)])
def test_false_singularities_are_found(axis, joint):
    q = at_false_singularity(axis, joint)
    factors = {name.split()[-1]: value for name, value in wrist_factors(q).items()}
    assert abs(factors[axis]) < 1e-12
    with pytest.raises(NoSolution, match=axis):
        joint_rates(ARM, q, np.array([0.1, 0.0, 0.0]))
