"""The correction of commands by measured joints: late, coarse, stuck, and with play."""

import numpy as np
import pytest

from hexarm.machines import load
from manipulator.trajectory.correction import Correction
from manipulator.trajectory.following_error import Tolerances
from manipulator.trajectory.play import Play

DT, DELAY = 0.01, 0.06
COUNT = np.full(6, 1e-4)


class Rig:
    """Joints that follow commands `ticks` later, as `plant` has it; the plan stands still."""

    def __init__(self, ticks, plant):
        self.machine = load('arm_6r_stepper')
        kinematics = self.machine.kinematics
        self.pose, self.joints = kinematics.home, kinematics.inverse(kinematics.home)
        following = Tolerances.of(self.machine).following
        self.correction = Correction(COUNT, following, DELAY, DT)
        self.ticks, self.plant, self.commands = ticks, plant, []

    def run(self, seconds, is_active=True):
        """The measured joints minus the reference's, at every tick (N, 6)."""
        errors = []
        for _ in range(round(seconds / DT)):
            pose = self.correction.step(self.machine, self.pose, self.joints, is_active)
            command = self.machine.kinematics.inverse(pose, self.joints)
            self.commands.append(command)
            late = self.commands[max(len(self.commands) - 1 - self.ticks, 0)]
            measured = COUNT * np.round(self.plant(late) / COUNT)
            self.correction.measure(measured)
            errors.append(measured - self.joints)
        return np.array(errors)


@pytest.mark.parametrize('times', [0.2, 1.0, 2.0, 3.0])
def test_an_offset_is_corrected_without_overshoot_up_to_three_times_the_delay(times):
    offset = np.radians([1.0, -1.0, 0.5, -0.5, 0.2, 0.0])
    errors = Rig(round(times * DELAY / DT), lambda q: q + offset).run(4.0)
    assert np.abs(errors[-1]).max() <= 3e-4
    assert (errors * np.sign(offset) >= -3e-4).all()


def test_encoders_that_are_coarser_than_commands_do_not_make_it_hunt():
    rig = Rig(6, lambda q: q + 0.4 * COUNT)
    rig.run(1.0)
    since = len(rig.commands)
    rig.run(5.0)
    assert np.ptp(rig.commands[since:], axis=0).max() < 1e-9


def test_what_does_not_respond_is_corrected_by_a_quarter_of_the_following_tolerance_at_most():
    rig = Rig(6, lambda q: np.zeros(6))
    rig.run(10.0)
    most = Tolerances.of(rig.machine).following / 4
    assert (np.abs(np.array(rig.commands) - rig.joints) <= most + 1e-6).all()


def test_it_changes_nothing_while_it_is_not_active():
    rig = Rig(6, lambda q: q + 0.01)
    rig.run(1.0)
    rig.run(0.3, is_active=False)
    since = len(rig.commands)
    rig.run(2.0, is_active=False)
    assert np.ptp(rig.commands[since:], axis=0).max() < 1e-12


def test_a_direction_that_is_new_begins_with_the_opposite_offset_and_keeps_its_own():
    play = Play(np.array([1e-3]), np.array([1.0]))
    play.move(np.array([0.0]))
    play.move(np.array([0.1]))
    play.add(np.array([0.02]), np.array([False]))
    play.move(np.array([0.05]))
    assert play.offset == pytest.approx(-0.02)
    play.add(np.array([-0.01]), np.array([False]))
    play.confirm(np.array([True]))
    play.move(np.array([0.1]))
    assert play.offset == pytest.approx(0.03)
    play.move(np.array([0.0]))
    assert play.offset == pytest.approx(-0.03)


def test_a_turn_within_the_dead_band_is_none():
    play = Play(np.array([1e-3]), np.array([1.0]))
    play.move(np.array([0.0]))
    play.add(np.array([0.02]), np.array([False]))
    for wobble in (0.0, 9e-4, 1e-4, 9e-4, 0.0):
        play.move(np.array([wobble]))
    assert play.offset == pytest.approx(0.02)


def test_the_next_turn_of_each_joint_is_seen_ahead_with_the_play_that_it_takes_up():
    play = Play(np.full(2, 1e-3), np.full(2, 1.0))
    play.move(np.zeros(2))
    play.add(np.full(2, 0.02), np.zeros(2, dtype=bool))
    rows = np.stack([np.sin(np.linspace(0.0, np.pi, 31)), np.linspace(0.0, 1.0, 31)], axis=1)
    turns, change = play.next_turns(rows)
    assert 15 < turns[0] < 18
    assert turns[1] == 31
    assert change == pytest.approx([-0.04, -0.04])


@pytest.mark.parametrize('counts', [1.0, 3.0])
def test_noisy_encoders_and_play_do_not_make_the_joints_swing(counts):
    rng, half = np.random.default_rng(1), np.radians(1.0)
    state = {'joints': None}

    def plant(command):
        before = command if state['joints'] is None else state['joints']
        state['joints'] = np.clip(before, command - half, command + half)
        return state['joints'] + counts * COUNT * rng.standard_normal(6)

    rig = Rig(6, plant)
    plant(rig.joints - 0.5 * half)
    errors = rig.run(20.0)
    swing = np.array(rig.commands)[round(5.0 / DT) :]
    assert np.ptp(swing, axis=0).max() < 2.2 * half + 20 * counts * COUNT[0]
    assert np.abs(errors[round(5.0 / DT) :]).mean() < 4 * counts * COUNT[0]


def test_a_correction_that_would_break_a_limit_on_poses_is_cut_to_the_part_that_keeps_it():
    machine = load('robocake')
    kinematics, constraints = machine.kinematics, machine.constraints
    lowest = kinematics.home.moved([0.0, 0.0, -0.01775, 0.0, 0.0, 0.0])
    joints = kinematics.inverse(lowest)
    assert constraints.admits(lowest, joints)
    down = joints - kinematics.inverse(kinematics.home.moved([0.0, 0.0, -0.0170, 0.0, 0.0, 0.0]))
    beyond = kinematics.forward(joints + down, lowest).pose
    assert not constraints.admits(beyond, joints + down)
    correction = Correction(COUNT, Tolerances.of(machine).following, DELAY, DT)
    heights = []
    for _ in range(300):
        pose = correction.step(machine, lowest, joints, is_active=True)
        correction.measure(joints - down)
        assert constraints.admits(pose, kinematics.inverse(pose, joints))
        heights.append(pose.position[2])
    assert min(heights) < lowest.position[2] - 2e-5
    assert np.abs(np.diff(heights)).max() < machine.motion.linear.speed * DT


@pytest.mark.parametrize('is_confirmed', [False, True])
def test_what_was_learned_of_a_direction_is_kept_once_the_joint_has_arrived(is_confirmed):
    """Of one that has not, the opposite of the other direction's is the better guess."""
    play, no = Play(np.full(1, 0.01), np.full(1, 1.0)), np.zeros(1, dtype=bool)
    play.move(np.zeros(1))
    play.move(np.full(1, 0.1))
    play.add(np.full(1, 0.03), no)
    play.confirm(np.full(1, is_confirmed))
    play.move(np.zeros(1))
    assert play.offset == pytest.approx(-0.03)
    play.add(np.full(1, 0.02), no)
    play.move(np.full(1, 0.1))
    assert play.offset == pytest.approx(0.03 if is_confirmed else 0.01)
