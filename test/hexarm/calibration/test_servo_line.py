from dataclasses import replace

from bridge.fake.board_thread import BoardThread, FakeMachine
from bridge.fake.fake_line import FakeLine
from bridge.protocol import Mode
from bridge.servo_config import BoardConfig
from hexarm import machines
from hexarm.calibration import servo_line
from hexarm.calibration.servo_line import ServoLine


def test_servos_may_take_longer_to_be_energised_than_a_board_to_answer(tmp_path, monkeypatch):
    monkeypatch.setattr(servo_line, 'ARM_WITHIN', 0.2)
    config = BoardConfig.from_machine(machines.read('robocake'))
    config = replace(config, servos=replace(config.servos, arm_interval_ms=100))
    path = tmp_path / 'board'
    machine = FakeMachine.from_config(config, boot_s=0.1, hysteresis=0.0)
    board = BoardThread(machine, FakeLine(path), lambda positions: None)
    board.start()
    try:
        with ServoLine(str(path), config) as line:
            line.energise((3000,) * 6)
            assert line.mode in (Mode.ARMED, Mode.HOLDING)
            assert None not in machine.board.pulses
    finally:
        board.close()
