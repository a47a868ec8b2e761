"""A program that hangs is reset within half a second, and comes back disarmed."""

import pytest

from bridge.protocol import Hello, Known, Mode, ResetCause
from firmware.simulator.chip import CLOCK_HZ


@pytest.mark.parametrize('with_interrupts', [True, False])
def test_a_hung_program_is_reset_within_half_a_second_and_disarmed(armed, with_interrupts):
    armed.chip.hang(with_interrupts)
    start = armed.chip.cycle
    messages = []
    while armed.chip.watchdog_resets == 0:
        messages = armed.run(0.001)
        assert armed.chip.cycle - start < CLOCK_HZ // 2
    armed.chip.edges()
    messages += armed.run(0.1)
    (hello,) = [m for m in messages if isinstance(m, Hello)]
    assert hello.reset_cause is ResetCause.WATCHDOG
    assert armed.state().mode is Mode.DISARMED
    assert {joint.known for joint in armed.last_state.joints} == {Known.UNKNOWN}
    assert len(armed.chip.edges()) == 0


def test_a_program_that_works_is_never_reset(armed):
    armed.run(30.0)
    assert armed.chip.watchdog_resets == 0
    assert armed.state().mode is Mode.HOLDING
