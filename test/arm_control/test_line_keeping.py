"""A jogged tool keeps the direction that was asked for, or stands and says why."""

import itertools
from dataclasses import replace

import numpy as np
import pytest

from arm_control.arm import SerialArm
from arm_control.line_keeping import Posture, singularity
from arm_control.load import arm as load_arm
from arm_control.load import jogging
from arm_control.resolved_rate import JogState
from manipulator import rotation as so3
from manipulator.errors import InvalidInput
from manipulator.framed_machine import in_frames
from manipulator.frames import Frames
from manipulator.pose import Pose
from manipulator.teleop.jogger import JogMotion, ticks_for, within_speed
from sampling import enough

DT = 0.01
OFF, TILTED = 2e-3, np.radians(1.0)
SLIDING = 'sliding off the line'


def drive(machine, start, twist, seconds=6.0):
    """Every motion from `start`, joints or a motion, until the arm has stood for a while."""
    jogger = machine.make_jogger(machine)
    if not isinstance(start, JogMotion):
        start = JogMotion.at_rest(machine.kinematics.forward(start).pose, start)
    motions, still = [start], 0
    while len(motions) <= seconds / DT and still < 20:
        motions.append(jogger.step(motions[-1], twist, DT))
        still = 0 if motions[-1].rates.any() else still + 1
    return motions


def off_line(motions, twist, length):
    """How far (metres, radians) each pose is from the nearest one of straight motion at `twist`.

    Straight: the tool point goes along a line while the tool turns evenly about a fixed axis.
    """
    start, (v, w) = motions[0].pose, (twist[:3], twist[3:])
    found, angle, turn = [], 0.0, np.linalg.norm(w)
    for motion in motions:
        gone = motion.pose.position - start.position
        turned = motion.pose.rotation @ start.rotation.T
        if turn:
            x, y, z, c = so3.to_quaternion(turned)
            now = 2 * np.arctan2(np.array([x, y, z]) @ w / turn, c)
            angle += (now - angle + np.pi) % (2 * np.pi) - np.pi
        t = (gone @ v / length**2 + angle * turn) / (v @ v / length**2 + w @ w)
        missed = so3.log(turned @ so3.exp(t * w).T)
        found.append((np.linalg.norm(gone - t * v), np.linalg.norm(missed)))
    return np.array(found).T


def check_on_line(machine, motions, twist):
    away, tilt = off_line(motions, twist, machine.kinematics.characteristic_length)
    assert away.max() < OFF
    assert tilt.max() < TILTED


def check_joints(machine, motions):
    limits, motion = machine.kinematics.limits, machine.motion.joint
    joints = np.array([m.joints for m in motions])
    rates = np.array([m.rates for m in motions])
    assert (joints <= limits.high).all() and (joints >= limits.low).all()
    assert (np.abs(rates) <= motion.speed * (1 + 1e-6)).all()
    changes = np.abs(np.diff(rates, axis=0)) / DT
    assert (changes <= motion.acceleration * (1 + 1e-6)).all()


def twists(machine, rng, count):
    """Along one axis or in a random direction, at full or a tenth of full speed."""
    full = np.repeat([machine.motion.linear.speed, machine.motion.angular.speed], 3)
    for _ in range(count):
        one = rng.choice([-1, 1]) * np.eye(6)[rng.integers(6)]
        some = rng.uniform(-0.5, 0.5, 6)
        yield rng.choice([0.1, 1.0]) * full * (one if rng.random() < 0.7 else some)


@pytest.fixture(scope='module')
def machine(machine_file):
    return load_arm(machine_file('arm_6r'))


@pytest.mark.parametrize('zeroed', [[], [2], [4], [2, 4], [0, 1, 2, 3, 4, 5]])
def test_singular_values_and_vectors_make_the_jacobian_where_some_are_zero_too(arm_6r, zeroed):
    length = np.array([arm_6r.characteristic_length])
    joints = np.array([0.3, -0.5, 1.0, 0.8, 0.7, -0.5])
    joints[zeroed] = 0.0
    posture = Posture.at(arm_6r.chain, length, joints)
    jacobian = arm_6r.chain.jacobian(joints)
    jacobian[:3] /= length
    left, sigma, right = posture.left, posture.sigma, posture.right
    assert np.abs(posture.jacobian - jacobian).max() < 1e-15
    assert np.abs((left * sigma) @ right - jacobian).max() < 1e-14
    assert np.abs(left.T @ left - np.eye(6)).max() < 1e-14
    assert np.abs(right @ right.T - np.eye(6)).max() < 1e-14
    assert (np.diff(sigma) <= 0.0).all()
    assert sigma == pytest.approx(np.linalg.svd(jacobian, compute_uv=False), abs=1e-14)
    assert arm_6r.sigma_min(arm_6r.home, joints) == pytest.approx(sigma[-1], abs=1e-14)


@pytest.mark.parametrize('name', ['arm_6r', 'ur5', 'puma560'])
def test_jogged_tool_keeps_its_line_and_comes_back_on_it(machine_file, name):
    machine, rng = load_arm(machine_file(name)), np.random.default_rng(8)
    limits, stops = machine.kinematics.limits, 0
    for twist in twists(machine, rng, enough(5, 16)):
        joints = rng.uniform(np.maximum(limits.low, -3.0), np.minimum(limits.high, 3.0))
        out = drive(machine, joints, twist)
        motions = out
        if not out[-1].rates.any():
            stops += 1
            assert out[-1].held_by
            back = drive(machine, out[-1], -twist, seconds=1.5)
            way = np.abs(back[0].pose.twist_to(back[-1].pose))
            assert way.max() > 1e-3
            motions = out + back
        assert not any(SLIDING in m.held_by for m in motions)
        check_on_line(machine, motions, twist)
        check_joints(machine, motions)
    assert stops > 1


def test_tool_driven_to_the_edge_of_reach_stops_on_its_line_and_is_driven_back(machine):
    out = drive(machine, machine.kinematics.rest, np.array([0, 0.2, 0, 0, 0, 0]))
    check_on_line(machine, out, np.array([0, 0.2, 0, 0, 0, 0]))
    assert not out[-1].rates.any()
    assert 'elbow singularity' in out[-1].held_by
    back = drive(machine, out[-1], np.array([0, -0.2, 0, 0, 0, 0]), seconds=1.0)
    assert back[0].pose.position[1] - back[-1].pose.position[1] > 0.05
    check_on_line(machine, out + back, np.array([0, 0.2, 0, 0, 0, 0]))


def test_tool_stops_so_near_the_edge_of_reach_that_nobody_misses_the_rest(machine):
    out = drive(machine, machine.kinematics.rest, np.array([0, 0.2, 0, 0, 0, 0]))
    beyond = out[-1].pose.moved([0, 1e-3, 0, 0, 0, 0])
    assert np.isnan(machine.kinematics.inverse_or_nan(beyond, out[-1].joints)).any()


def test_aligned_wrist_turned_about_a_lost_axis_does_not_move_its_point(machine):
    joints = machine.kinematics.rest.copy()
    joints[4] = 1e-9
    for axis in (3, 4, 5):
        for sign in (1.0, -1.0):
            twist = sign * np.eye(6)[axis]
            check_on_line(machine, drive(machine, joints, twist, seconds=1.0), twist)


def test_motion_that_loses_nothing_goes_through_an_aligned_wrist(machine):
    """Planar motion: the lost direction, a turn out of the plane, is not asked for."""
    joints, twist = machine.kinematics.rest.copy(), np.array([0, 0, 0, 0.6, 0, 0])
    joints[4] = 0.3
    out = drive(machine, joints, twist, seconds=1.0)
    assert out[-1].joints[4] < -0.2
    assert min(m.scale for m in out) == 1.0
    check_on_line(machine, out, twist)


def test_stretched_arm_is_pulled_back_along_the_line(machine):
    """From straight up, where nothing moves the tool down at first order."""
    down = np.array([0, 0, -0.2, 0, 0, 0])
    out = drive(machine, np.zeros(6), down, seconds=2.0)
    assert out[0].pose.position[2] - out[-1].pose.position[2] > 0.2
    check_on_line(machine, out, down)
    stands = drive(machine, np.zeros(6), -down, seconds=0.5)
    assert np.array_equal(stands[-1].joints, np.zeros(6))
    assert 'singularity' in stands[-1].held_by


def test_sliding_is_done_only_where_it_was_asked_for_and_is_said(machine):
    out = np.array([0, 0.2, 0, 0, 0, 0])
    slid = drive(replace(machine, jog_singularity='slide'), machine.kinematics.rest, out)
    away, _ = off_line(slid, out, machine.kinematics.characteristic_length)
    assert away.max() > 10 * OFF
    first = int(np.argmax(away > OFF))
    assert SLIDING in slid[first].held_by
    assert 'elbow singularity' in slid[first].held_by


@pytest.mark.parametrize(
    ('name', 'joints', 'word'),
    [
        ('arm_6r', [0.4, 0.7, 0.0, 0.6, 1.0, 0.2], 'elbow'),
        ('arm_6r', [0.4, 0.7, 1.0, 0.6, 0.0, 0.2], 'wrist'),
        ('arm_6r', [0.4, -0.5, 1.0, 0.6, 1.0, 0.2], 'shoulder'),
        ('ur5', [0.3, -1.0, 0.0, 0.5, 1.0, 0.2], 'elbow'),
        ('ur5', [0.3, -1.0, 1.2, 0.5, 0.0, 0.2], 'wrist'),
    ],
)
def test_singularity_is_named_by_the_place_where_it_is(machine_file, name, joints, word):
    jog = jogging(machine_file(name))
    posture = jog.posture(np.array(joints))
    assert posture.sigma_min < 1e-9
    assert singularity(jog.arm.method, posture.right[-1]).startswith(f'{word} singularity')


def test_arm_without_such_places_names_the_joints_that_cancel_each_other(machine_file):
    straight = jogging(machine_file('arm_6r')).arm
    rng = np.random.default_rng(4)
    axes = straight.chain.axes + rng.normal(scale=0.3, size=(6, 3))
    axes /= np.linalg.norm(axes, axis=1)[:, None]
    chain = type(straight.chain)(axes, straight.chain.points, straight.chain.home)
    arm = SerialArm(chain, straight.limits, straight.characteristic_length, straight.rest)
    idle = np.array([0.0, 0.5, -1.0, 0.1, 0.6, 0.0])
    assert singularity(arm.method, idle) == (
        'singular posture (joints 2, 3 and 5 cancel each other)'
    )


def test_acceleration_at_constant_joint_rates_is_that_of_the_moving_tool(jog):
    rng = np.random.default_rng(5)
    for _ in range(10):
        joints, rates, h = rng.uniform(-1, 1, 6), rng.uniform(-1, 1, 6), 1e-5
        after, before = jog.posture(joints + h * rates), jog.posture(joints - h * rates)
        moving = (after.jacobian - before.jacobian) @ rates / (2 * h)
        assert np.abs(jog.posture(joints).turning(rates) - moving).max() < 1e-8


def test_arm_braking_before_a_stop_keeps_its_joints_accelerations(jog):
    """Towards stops near singular postures, where joints turn ever faster on a straight line."""
    limits, rng = jog.arm.limits, np.random.default_rng(12)
    acceleration = np.minimum(limits.acceleration, jog.motion.joint.acceleration)
    for _ in range(enough(5, 25)):
        state = JogState.at_rest(rng.uniform(limits.low, limits.high))
        twist = rng.uniform(-1, 1, 6) * ([0.25] * 3 + [1.5] * 3)
        for _ in range(150):
            before, state = state, jog.step(state, twist, DT).state
            changes = np.abs(state.rates - before.rates) / DT
            assert (changes <= acceleration * (1 + 1e-6)).all()


@pytest.mark.parametrize('name', ['arm_6r', 'ur5', 'puma560'])
def test_tool_keeps_its_accelerations_where_joints_cannot_follow(machine_file, name):
    """By differences of poses, at twists that change while the last one is not reached."""
    work = Pose.from_xyz_rpy(np.array([0.1, -0.2, 0.3]), np.array([0.4, -0.5, 2.0]))
    bare = load_arm(machine_file(name))
    machine = in_frames(bare, Frames(work).with_pivot([0.03, -0.05, 0.06]))
    rng, motion, limits = np.random.default_rng(14), bare.motion, bare.kinematics.limits
    full = np.repeat([motion.linear.speed, motion.angular.speed], 3)
    for _ in range(enough(5, 25)):
        motions = [rng.uniform(np.maximum(limits.low, -3.0), np.minimum(limits.high, 3.0))]
        for _ in range(8):
            target = within_speed(rng.uniform(-1, 1, 6) * full, motion)[0]
            motions += drive(machine, motions.pop(), target, seconds=rng.uniform(0.02, 0.5))
        joints = np.array([m.joints for m in motions])
        steps = [a.pose.twist_to(b.pose) for a, b in itertools.pairwise(motions)]
        changes = np.diff(np.array(steps) / DT, axis=0)
        away_from_stops = np.minimum(joints - limits.low, limits.high - joints).min(axis=1) > 0.05
        regular = bare.kinematics.sigma_min(motions[0].pose, joints) > 0.2
        judged = changes[(away_from_stops & regular)[1:-1]]
        assert all(ticks_for(change, motion, DT) < 1.05 for change in judged)


def test_another_word_for_what_a_jog_does_at_a_singularity_is_refused(machine):
    with pytest.raises(InvalidInput, match=r"jog_singularity is 'skid', needs 'stop' or 'slide'"):
        replace(machine, jog_singularity='skid')
