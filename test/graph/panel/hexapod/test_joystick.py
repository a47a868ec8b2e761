"""The joystick of the page is a deadman: whatever takes the hand away stops the machine."""

import time

import pytest

pytestmark = [pytest.mark.graph, pytest.mark.real_time]

JOG = 0.003
"""Metres that tell a jog from standing still. The reach is 15 mm, so jogs are slow: a busy
computer must not come to its end meanwhile."""

TAKEN = 'another page has the joystick'


def test_release_stops(page, machine):
    machine.jog(page, '#move', (0.0, 0.12), 0, JOG)
    released = time.time()
    page.let_go()
    assert machine.seconds_to_rest(released) < 1.0
    assert_zero_was_sent(machine)


def assert_zero_was_sent(machine):
    last = machine.twists[-1].twist
    assert (last.linear.x, last.linear.y, last.linear.z) == (0.0, 0.0, 0.0)


def test_a_window_that_loses_the_focus_stops(page, machine):
    tab = page.page
    session = tab.context.new_cdp_session(tab)
    session.send('Emulation.setFocusEmulationEnabled', {'enabled': False})  # as outside of tests
    machine.jog(page, '#move', (0.0, 0.12), 0, JOG)
    blurred = time.time()
    another_tab = tab.context.new_page()
    assert machine.seconds_to_rest(blurred) < 1.0
    assert_zero_was_sent(machine)
    another_tab.close()
    session.send('Emulation.setFocusEmulationEnabled', {'enabled': True})


@pytest.mark.parametrize('end', ['touchEnd', 'touchCancel'])
def test_a_touch_that_ends_or_is_taken_away_stops(page, machine, end):
    session = page.page.context.new_cdp_session(page.page)
    (x, y), half = page.centre('#move')

    def touch(kind, *points):
        session.send('Input.dispatchTouchEvent', {'type': kind, 'touchPoints': list(points)})

    touch('touchStart', {'x': x, 'y': y})
    touch('touchMove', {'x': x, 'y': y - 0.12 * half[1]})
    machine.client.wait('a jog', lambda: machine.has_moved(0, JOG), 20.0)
    ended = time.time()
    touch(end)
    assert machine.seconds_to_rest(ended) < 1.0
    assert_zero_was_sent(machine)


def test_a_page_that_stands_still_stops_and_does_not_resume(page, machine):
    machine.jog(page, '#lift', (0.0, 0.12), 2, JOG / 2)
    page.page.evaluate('() => { const end = Date.now() + 1500; while (Date.now() < end); }')
    page.says('press again')
    machine.stays(0.5)
    page.let_go()
    machine.jog(page, '#lift', (0.0, -0.12), 2, -JOG / 2)


def test_two_pages_do_not_fight(two_pages, machine):
    first, second = two_pages
    press_both(first, second, machine)
    machine.client.spin(0.5)
    first.let_go()
    machine.stays(0.5)
    assert all(twist.twist.linear.x >= 0.0 for twist in machine.twists), 'the second page moved it'
    second.let_go()
    machine.jog(second, '#move', (0.0, -0.12), 0, -JOG / 2)


def press_both(first, second, machine):
    """The first page moves forward, then the second presses backwards, and is told who has it."""
    for _ in range(8):
        machine.jog(first, '#move', (0.0, 0.12), 0, JOG / 3)
        second.hold('#move', 0.0, -0.12)
        machine.client.spin(0.5)
        if second.said == TAKEN:
            return
        # A busy computer had lost the first one's press, or has not yet heard the second's. What
        # the second did meanwhile is still on its way: only after a rest can it be forgotten.
        second.let_go()
        first.let_go()
        machine.begin()
    raise AssertionError(second.said)


def test_closing_the_page_while_jogging_stops(two_pages, machine):
    page = two_pages.pop()
    machine.jog(page, '#move', (-0.12, 0.0), 1, JOG)
    closed = time.time()
    page.page.close()
    assert machine.seconds_to_rest(closed) < 1.5
