"""The stop button: a contact that opens, so that a broken wire stops too."""

from bridge.protocol import Arm, Clear, Mode, Result, Setpoint

PARK = (3000, 2900, 3100, 3000, 2900, 3100)
FAR = (4800, 1200, 4800, 1200, 4800, 1200)


def test_the_stop_button_holds_the_pulses_and_latches(armed):
    armed.say(Setpoint(1000, FAR))
    armed.run(0.05)
    armed.board.is_stop_open = True
    armed.run(0.03)
    there = armed.state()
    assert there.mode is Mode.STOPPED
    armed.run(0.5)
    assert armed.state().joints == there.joints
    assert armed.ask(Clear()) is Result.STOPPED
    armed.board.is_stop_open = False
    armed.run(0.1)
    assert armed.state().mode is Mode.STOPPED
    assert armed.ask(Arm(PARK)) is Result.STOPPED
    assert armed.ask(Clear()) is Result.OK
    assert armed.state().joints == there.joints


def test_with_the_stop_contact_open_nothing_arms(host):
    host.board.is_stop_open = True
    host.run(0.1)
    assert host.ask(Arm(PARK)) is Result.STOPPED
    host.run(1.0)
    assert host.board.pulses == (None,) * 6


def test_a_spark_on_the_stop_wire_stops_nothing(armed):
    armed.board.is_stop_open = True
    armed.run(0.001)
    armed.board.is_stop_open = False
    armed.run(0.1)
    assert armed.state().mode is Mode.ARMED
