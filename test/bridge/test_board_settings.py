from dataclasses import replace

from bridge.fake.board_settings import BoardSettings
from bridge.servo_config import BoardConfig
from hexarm import machines


def test_a_board_has_times_and_voltage_of_the_machine_file_in_its_own_units():
    config = BoardConfig.from_machine(machines.read('robocake'))
    servos = replace(config.servos, arm_interval_ms=1040, minimum_battery_v=6.35)
    settings = BoardSettings.from_config(replace(config, servos=servos), boot_s=0.1)
    assert settings.arm_interval_us == 1_040_000
    assert settings.minimum_battery_mv == 6350
    assert settings.boot_us == 100_000
    assert settings.machine.arm_interval_ms == 1040
    assert settings.machine.minimum_battery_mv == 6350
    assert settings.machine.joint_count == 6
