import pytest

from manipulator.deadlines import RELEASE
from manipulator.errors import Refused
from manipulator.teleop.arbiter import COMPUTER, Arbiter

JOY, PANEL = 'cmd_vel/joy', 'cmd_vel/panel'
LATER = RELEASE + 0.01


def test_nobody_has_the_machine_at_first():
    assert Arbiter().owner(0.0) == ''


def test_whoever_moves_first_has_it_until_he_falls_silent():
    arbiter = Arbiter()
    arbiter.receive(JOY, 0.0)
    with pytest.raises(Refused, match='cmd_vel/joy controls the machine'):
        arbiter.receive(PANEL, 0.1)
    assert arbiter.owner(RELEASE) == JOY
    assert arbiter.owner(LATER) == ''
    arbiter.receive(PANEL, 1.0)
    assert arbiter.owner(1.0) == PANEL


def test_one_who_was_rejected_must_release_before_he_is_received():
    arbiter = Arbiter()
    arbiter.receive(JOY, 0.0)
    for k in range(1, 20):
        with pytest.raises(Refused, match='release first'):
            arbiter.receive(PANEL, 0.1 * k)
    assert arbiter.owner(1.9) == ''
    arbiter.receive(PANEL, 1.9 + LATER)
    assert arbiter.owner(1.9 + LATER) == PANEL


def test_a_person_overrides_the_computer_whose_stream_does_not_resume_by_itself():
    arbiter = Arbiter()
    arbiter.receive(COMPUTER, 0.0)
    arbiter.receive(JOY, 0.02)
    assert arbiter.owner(0.02) == JOY
    for k in range(2, 30):
        with pytest.raises(Refused, match='took over the machine'):
            arbiter.receive(COMPUTER, 0.02 * k)
    assert arbiter.owner(0.58) == ''
    arbiter.receive(COMPUTER, 0.58 + LATER)
    assert arbiter.owner(0.58 + LATER) == COMPUTER


def test_the_computers_twists_wait_for_a_goal_and_a_persons_do_not():
    arbiter = Arbiter()
    with pytest.raises(Refused, match='a goal is active'):
        arbiter.receive(COMPUTER, 0.0, is_computer_busy=True)
    with pytest.raises(Refused, match='release first'):
        arbiter.receive(COMPUTER, 0.1)
    arbiter.receive(JOY, 0.2, is_computer_busy=True)
    assert arbiter.owner(0.2) == JOY


def test_after_a_stop_the_owner_must_release():
    arbiter = Arbiter()
    arbiter.receive(JOY, 0.0)
    arbiter.stop()
    assert arbiter.owner(0.01) == ''
    with pytest.raises(Refused, match='stopped'):
        arbiter.receive(JOY, 0.02)
    arbiter.receive(JOY, 0.02 + LATER)
    assert arbiter.owner(0.02 + LATER) == JOY


def test_owner_who_is_rejected_has_nothing_until_he_has_released():
    arbiter = Arbiter()
    arbiter.receive(JOY, 0.0)
    with pytest.raises(Refused, match='two of them: release first'):
        arbiter.reject(JOY, 0.02, 'two of them')
    assert arbiter.owner(0.02) == ''
    with pytest.raises(Refused, match='two of them'):
        arbiter.receive(JOY, 0.04)
    arbiter.receive(JOY, 0.04 + LATER)
    assert arbiter.owner(0.04 + LATER) == JOY
