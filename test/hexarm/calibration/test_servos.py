"""The real process on a real terminal, with a board whose servos are not as the file says."""

import contextlib
import difflib
import os
import signal

import numpy as np
import pytest

from bridge.frames import encode
from bridge.protocol import Arm, Mode
from bridge.servo_config import BoardConfig
from hexarm import machines
from hexarm.calibration.servo_line import changed_values
from hexarm.calibration.servos import FakeServos, mounted_wrongly
from hexarm.cli.main import main

WRONG = {
    0: {'sign': -1, 'centre_us': 1540.0},
    1: {'centre_us': 1460.0, 'us_per_deg': 10.0},
}


def test_after_a_session_the_file_holds_the_true_values_and_nothing_else_has_changed(
    persist, sit_down
):
    def session():
        person, file = sit_down(WRONG, '--only', 'crank_1', 'crank_2')
        before = file.read_text()
        person.begin()
        for channel, name in ((0, 'crank_1'), (1, 'crank_2')):
            start = person.positions[channel]
            person.jog_to(channel, 1540.0)
            person.await_that(
                'a move', lambda c=channel, s=start: abs(person.positions[c] - s) > 0.02
            )
            person.type('y' if person.positions[channel] > start else 'n')
            person.await_words(f'{name}, centre')
            if channel == 1:
                person.jog_to(channel, 1460.0)
            assert np.degrees(person.positions[channel]) == pytest.approx(120.0, abs=0.5)
            person.type('\r')
            person.await_words(f'{name}, scale')
            if channel == 1:
                person.jog_to(channel, 1560.0)
                angle = np.degrees(person.positions[channel])
                assert angle == pytest.approx(110.0, abs=0.5)
                person.type('=110\r')
            else:
                person.type('s')
            person.await_words(f'{name}, range')
            person.type('\r')
            person.await_words('direction' if channel == 0 else 'end:')
        person.type('w')
        assert person.await_end() == 0
        assert person.pulses == (None,) * 6
        servos = BoardConfig.from_machine(machines.read(str(file))).servos.joints
        assert (servos[0].sign, servos[0].centre_us, servos[0].us_per_deg) == (-1, 1540.0, 10.5)
        assert (servos[1].sign, servos[1].centre_us, servos[1].us_per_deg) == (-1, 1460.0, 10.0)
        changed = list(difflib.ndiff(before.split('\n'), file.read_text().split('\n')))
        assert sum(line.startswith('+ ') for line in changed) == 2

    persist(session)


def test_space_stops_and_nothing_moves_until_it_is_cleared(persist, sit_down):
    def session():
        person, _ = sit_down({})
        person.begin()
        person.type('+\x1b[C')
        person.await_that('a move', lambda: person.pulses[0] > 3000)
        person.type(' ')
        person.await_that('a stop', lambda: person.machine.board.mode is Mode.STOPPED)
        person.await_words('STOPPED')
        there = person.pulses
        person.type('\x1b[C')
        person.await_words('STOPPED')
        assert person.pulses == there
        person.type('c')
        person.await_that('clear', lambda: person.machine.board.mode is Mode.ARMED)
        person.await_rest(0)
        assert person.pulses == there

    persist(session)


@pytest.mark.parametrize('end', ['ctrl-c', 'terminate', 'terminal', 'after a stop'])
def test_servos_go_off_however_the_session_ends(persist, sit_down, end):
    def session():
        person, file = sit_down({})
        before = file.read_text()
        person.begin()
        person.type('\x1b[C')
        person.await_that('a move', lambda: person.pulses[0] > 3000)
        if end == 'after a stop':
            person.type(' ')
            person.await_that('a stop', lambda: person.machine.board.mode is Mode.STOPPED)
        if end == 'terminal':
            person.hang_up()
        else:
            number = signal.SIGTERM if end == 'terminate' else signal.SIGINT
            os.kill(person.process.pid, number)
        person.process.wait(60)
        assert person.pulses == (None,) * 6
        assert file.read_text() == before

    persist(session)


def test_a_board_that_vanishes_ends_the_session_in_words(persist, sit_down):
    def session():
        person, _ = sit_down({})
        person.begin()
        person.board.do(lambda: person.board.plug(None))
        assert person.await_end() == 1
        assert 'Traceback' not in person.all_said
        assert 'was disconnected' in person.said
        assert 'pull their plug' in person.said

    persist(session)


@pytest.mark.parametrize('why', ['was disconnected', 'the battery is too low'])
def test_what_was_found_is_not_lost_with_the_board(persist, sit_down, why):
    def session():
        person, file = sit_down(WRONG, '--only', 'crank_1')
        person.begin()
        person.jog_to(0, 1540.0)
        person.type('n')
        person.await_words('crank_1, centre')
        person.type('\r')
        person.await_words('crank_1, scale')
        is_there = why != 'was disconnected'
        if is_there:
            person.machine.board.battery_mv = 5000
        else:
            person.board.do(lambda: person.board.plug(None))
        person.await_words(why)
        person.await_words('w: write what was found so far')
        assert ('pull the plug' in person.all_said, person.pulses[0] is None) == (
            not is_there,
            is_there,
        )
        person.type(' w')
        assert person.await_end() == 0
        first = BoardConfig.from_machine(machines.read(str(file))).servos.joints[0]
        assert (first.sign, first.centre_us) == (-1, 1540.0)

    persist(session)


def test_a_file_that_somebody_else_has_changed_is_left_alone(persist, sit_down):
    def session():
        person, file = sit_down({}, '--only', 'crank_1')
        person.begin()
        file.write_text(file.read_text() + '# mine\n')
        person.type('s')
        person.await_words('centre')
        person.type('=119\r')
        person.await_words('scale')
        person.type('q')
        person.await_words('end:')
        person.type('w')
        assert person.await_end() == 2
        assert 'changed meanwhile' in person.said
        assert file.read_text().endswith('# mine\n')

    persist(session)


def test_without_consent_no_servo_gets_a_pulse(persist, sit_down):
    def session():
        person, _ = sit_down({})
        person.await_words('ENTER energises')
        person.type('q')
        assert person.await_end() == 0
        assert 'nothing was written' in person.said
        assert person.pulses == (None,) * 6

    persist(session)


def test_a_platform_that_the_board_holds_up_is_not_dropped_without_consent(persist, sit_down):
    def session():
        person, _ = sit_down({})

        def arm():
            board = person.machine.board
            board.step(0.1)  # its boot, in which it hears nothing
            board.feed(encode(Arm((3000,) * 6), 1))

        person.board.do(arm)
        person.await_words('ENTER energises')
        person.type('q')
        assert person.await_end() == 0
        assert 'left as they were' in person.said
        assert person.pulses == (3000.0,) * 6

    persist(session)


WITH_BOARD = [n for n in sorted(machines.shipped()) if machines.read(n).driver == 'serial']


@pytest.mark.parametrize('name', WITH_BOARD)
def test_a_fake_board_can_be_tried_with_every_machine(name):
    config = BoardConfig.from_machine(machines.read(name))
    wrong = mounted_wrongly(config, 7)
    changed = changed_values(config.servos.joints, wrong.servos.joints)
    assert {place[-1] for place in changed} == {'sign', 'centre_us'}
    with FakeServos(wrong) as fake:
        assert os.path.exists(fake.port)
    assert not os.path.exists(fake.port)


def test_a_port_that_another_program_holds_is_reported_kindly(persist, sit_down):
    def session():
        person, _ = sit_down({})
        person.await_words('ENTER energises')
        with contextlib.closing(person.another()) as other:
            assert other.await_end() == 1
            assert 'end hexarm up' in other.said

    persist(session)


@pytest.mark.parametrize(
    ('words', 'text'),
    [
        (['robocake'], '--output my_robocake.yaml'),
        (['robocake', '--output', '/nowhere/x.yaml'], 'is not a folder'),
        (['robocake', '--output', __file__], 'not overwritten'),
        (['robocake', '--output', 'new.yaml', '--only', 'crnk_1'], "did you mean 'crank_1'"),
        (['robocake', '--output', 'new.yaml'], 'needs a terminal'),
    ],
)
def test_what_cannot_be_is_reported_before_anything_moves(words, text, capsys, monkeypatch):
    with open(os.devnull) as nothing:
        monkeypatch.setattr('sys.stdin', nothing)
        assert main(['calibrate', 'servos', *words]) == 2
    assert text in capsys.readouterr().err
