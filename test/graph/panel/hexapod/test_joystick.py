"""The joystick of the page is a deadman: a hand that is gone stops the machine.

test/hexarm/panel/test_joystick_page.py tries what counts as gone; here is one of each way out.
"""

import time

import pytest

pytestmark = pytest.mark.graph

JOG = 0.003
"""Metres that tell a jog from standing still. The reach is 15 mm, so jogs are slow: a busy
computer must not come to its end meanwhile."""


def test_release_stops(page, machine):
    machine.jog(page, '#move', (0.0, 0.12), 0, JOG)
    released = time.time()
    page.let_go()
    machine.seconds_to_rest(released)
    assert_zero_was_sent(machine)


def assert_zero_was_sent(machine):
    last = machine.twists[-1].twist
    assert (last.linear.x, last.linear.y, last.linear.z) == (0.0, 0.0, 0.0)


def test_closing_the_page_while_jogging_stops(two_pages, machine):
    page = two_pages.pop()
    machine.jog(page, '#move', (-0.12, 0.0), 1, JOG)
    closed = time.time()
    page.page.close()
    machine.seconds_to_rest(closed)
