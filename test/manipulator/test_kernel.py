"""Nothing that does not fit reaches the mathematics in C."""

import ast
from array import array as packed
from pathlib import Path

import numpy as np
import pytest

from hexapod_control.leg_jacobian import smallest_singular_value
from hexarm.machines import load
from manipulator import _kernel
from manipulator import rotation as so3
from manipulator.arrays import frozen, stretched
from manipulator.errors import InvalidInput, NoSolution
from manipulator.limits.constraints import Constraints
from manipulator.pose import Pose

STUB = Path(__file__).parents[2] / 'manipulator' / '_kernel.pyi'
MACHINE = load('robocake')
HEXAPOD = MACHINE.kinematics


def declared():
    functions = ast.parse(STUB.read_text()).body
    return {f.name: len(f.args.args) for f in functions if isinstance(f, ast.FunctionDef)}


def misaligned(count):
    return np.zeros(8 * count + 1, np.uint8)[1:].view(np.float64)


def test_every_function_takes_as_many_arrays_as_are_declared():
    exported = {name for name in dir(_kernel) if not name.startswith('_')}
    assert exported == set(declared())
    for name, count in declared().items():
        with pytest.raises(TypeError, match=f'{name} takes {count} arrays, not {count + 1}'):
            getattr(_kernel, name)(*[np.zeros(0)] * (count + 1))


@pytest.mark.parametrize(
    'array',
    [
        np.zeros(9, np.float32),
        np.zeros(9, '>f8'),
        np.zeros(9, np.int64),
        np.zeros((3, 6))[:, ::2],
        np.zeros((3, 4)).T[:3],
        misaligned(9),
        memoryview(bytes(73))[1:].cast('d'),
        np.zeros(8),
        np.zeros(18),
        [0.0] * 9,
        None,
    ],
    ids=lambda array: f'{getattr(array, "dtype", type(array).__name__)}',
)
def test_what_is_not_nine_adjacent_doubles_is_rejected(array):
    vector = np.full(3, 7.0)
    with pytest.raises((TypeError, ValueError)):
        _kernel.rotation_log(array, vector)
    assert (vector == 7.0).all()


@pytest.mark.parametrize(
    'matrix',
    [
        packed('d', np.eye(3).ravel()),
        np.eye(3).view(np.recarray),
        memoryview(np.eye(3)),
        np.eye(3).view(np.dtype('f8').newbyteorder('little')),
    ],
)
def test_other_buffers_of_doubles_are_read_as_arrays_are(matrix):
    vector = np.full(3, 7.0)
    _kernel.rotation_log(matrix, vector)
    assert (vector == 0.0).all()
    with pytest.raises(ValueError, match='array 2 has 9 numbers, needs 27'):
        _kernel.rotation_exp(matrix, np.zeros(9))


def test_part_of_an_item_lacks_the_rest_of_it():
    for numbers, needed in ((1, 3), (5, 6)):
        with pytest.raises(ValueError, match=f'array 1 has {numbers} numbers, needs {needed}'):
            _kernel.rotation_exp(np.zeros(numbers), np.zeros(9))


def test_nothing_is_written_where_nothing_may_be():
    with pytest.raises(ValueError, match='read-only'):
        _kernel.rotation_log(np.eye(3), frozen(np.zeros(3)))


def test_poses_hold_adjacent_numbers_however_they_are_made():
    turned, place = so3.exp([[0.1, 0.2, 0.3]] * 4), np.arange(24.0).reshape(3, 8).T[::2]
    poses = (
        Pose(place, np.swapaxes(turned, -1, -2)),
        Pose(place, np.eye(3)),
        Pose(place, turned).inverse(),
        Pose(place, turned)[::-2],
        Pose(place, turned)[:, None],
        Pose(place, turned).moved(np.ones((1, 6))[:, ::-1]),
        Pose(place[0], turned[0]).moved(np.ones((5, 6))),
    )
    for pose in poses:
        for array in (pose.position, pose.rotation):
            assert array.flags.c_contiguous
            assert array.flags.aligned
            assert not array.flags.writeable
        HEXAPOD.inverse_or_nan(pose)


def test_a_pose_taken_over_with_gaps_is_rejected():
    pose = Pose.unchecked(np.zeros((4, 6))[:, ::2], np.zeros((4, 3, 3)))
    with pytest.raises(ValueError, match='contiguous'):
        HEXAPOD.inverse_or_nan(pose)


def test_no_poses_have_no_joints():
    nothing = Pose(np.zeros((0, 3)), np.zeros((0, 3, 3)))
    joints = HEXAPOD.inverse(nothing)
    assert joints.shape == (0, 6)
    assert HEXAPOD.inverse(nothing, np.zeros(6)).shape == (0, 6)
    assert HEXAPOD.sigma_min(nothing, joints).shape == (0,)
    assert MACHINE.constraints.admits(nothing, joints).shape == (0,)
    assert MACHINE.constraints.values(nothing, joints).shape[0] == 0
    assert nothing.moved(np.zeros(6)).position.shape == (0, 3)
    assert so3.log(np.zeros((0, 3, 3))).shape == (0, 3)


def test_joints_may_have_gaps_and_other_number_types():
    home = HEXAPOD.home
    joints = HEXAPOD.inverse(home)
    apart, single = np.zeros(12), joints.astype(np.float32)
    apart[::2] = joints
    assert HEXAPOD.sigma_min(home, apart[::2]) == HEXAPOD.sigma_min(home, joints)
    assert HEXAPOD.forward(apart[::2]).sigma_min == HEXAPOD.forward(joints).sigma_min
    assert bool(MACHINE.constraints.admits(home, single))
    assert np.abs(HEXAPOD.crank_tips(single) - HEXAPOD.crank_tips(joints)).max() < 1e-7


@pytest.mark.parametrize('bad', [np.nan, np.inf])
def test_numbers_without_end_are_refused(bad):
    home, joints = HEXAPOD.home, HEXAPOD.inverse(HEXAPOD.home)
    broken = np.where(np.arange(6) == 2, bad, joints)
    free = Constraints(MACHINE.constraints.limits[:2])  # that rods close: any joints in range
    for limits in (MACHINE.constraints, free):
        assert limits.admits(home, joints)
        assert not limits.admits(home, broken)
    assert np.isnan(HEXAPOD.crank_tips(broken)[2]).all()
    with pytest.raises(NoSolution, match='finite'):
        HEXAPOD.forward(broken)
    with pytest.raises(InvalidInput, match='near'):
        HEXAPOD.inverse(home, broken)
    with pytest.raises(InvalidInput, match='not finite'):
        home.moved(np.where(np.arange(6) == 4, bad, 0.0))


def test_arrays_of_other_shapes_are_refused_by_name():
    for function, shape in ((so3.exp, (3, 2)), (so3.log, (9,)), (so3.log, (2, 3, 4))):
        with pytest.raises(InvalidInput, match=r'needs \(\.\.\., 3'):
            function(np.zeros(shape))
    with pytest.raises(NoSolution, match='shape'):
        HEXAPOD.forward(np.zeros(5))
    with pytest.raises(ValueError, match='broadcast'):
        HEXAPOD.inverse(HEXAPOD.home, np.zeros(5))
    for shape in ((2, 5), (3, 4)):  # the second has as many numbers as two items
        with pytest.raises(ValueError, match='broadcast'):
            HEXAPOD.base_points(np.zeros(shape))
    with pytest.raises(ValueError, match='broadcast'):
        smallest_singular_value(np.zeros((3, 12, 3)), 1.0)


def test_cranks_turned_very_far_are_where_they_are():
    for turns in (3, 10**4, 10**6, 10**10):
        joints = 2.0 + 2 * np.pi * turns + 0.1 * np.arange(6)
        direction = HEXAPOD.crank_tips(joints) - HEXAPOD.geometry.crank_centres
        g = HEXAPOD.geometry
        along = (direction * g.tangents).sum(axis=1) / g.crank_lengths
        np.testing.assert_allclose(along, np.cos(joints), atol=1e-12)


def test_stretched_copies_only_what_does_not_fit():
    array = np.zeros((2, 3))
    assert stretched(array, (2, 3)) is array
    for other in (array.T, np.zeros(2), misaligned(6).reshape(3, 2)):
        fitting = stretched(other, (3, 2))
        assert fitting.flags.c_contiguous
        assert fitting.flags.aligned
