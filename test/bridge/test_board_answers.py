from concurrent.futures import Future

import pytest

from bridge import board_answers
from bridge.board_answers import BoardAnswers
from bridge.messages import Clear, Disarm, Stop


@pytest.mark.parametrize(('command', 'is_given_up'), [(Clear(), True), (Stop(), False)])
def test_what_was_said_to_have_failed_is_not_sent_later_but_for_a_stop(
    monkeypatch, command, is_given_up
):
    monkeypatch.setattr(board_answers, 'ANSWER_WITHIN', 0.01)
    asked: Future[None] = Future()
    answers = BoardAnswers(lambda command: asked, lambda: '')
    assert answers.ask(command, 'done') == (False, 'no answer within 0.01 s')
    assert asked.cancelled() is is_given_up


def test_an_obeyed_command_is_said_to_be_done():
    asked: Future[None] = Future()
    asked.set_result(None)
    assert BoardAnswers(lambda command: asked, lambda: '').ask(Disarm(), 'off') == (True, 'off')
