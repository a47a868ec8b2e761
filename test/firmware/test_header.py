"""machine.h: the machine file stays the one source."""

import dataclasses
import re

import pytest

from bridge.board_settings import BoardSettings
from bridge.calibration import Calibration
from bridge.servo_config import BoardConfig
from hexarm import firmware_build, machines
from hexarm.firmware_header import header, header_of
from hexarm.main import main
from manipulator.errors import ConfigError


def definitions(text):
    return dict(re.findall(r'^#define (\w+) (.+)$', text, re.MULTILINE))


def test_every_number_comes_from_the_machine_file(capsys):
    assert main(['firmware-header', 'robocake']) == 0
    found = definitions(capsys.readouterr().out)
    config = BoardConfig.from_machine(machines.read('robocake'))
    ranges = Calibration.from_config(config.servos).count_ranges
    assert found['JOINT_COUNT'] == '6'
    assert found['BAUD'] == '250000UL'
    assert found['LOWEST_COUNTS'] == '{' + ', '.join(str(low) for low, _ in ranges) + '}'
    assert found['HIGHEST_COUNTS'] == '{' + ', '.join(str(high) for _, high in ranges) + '}'
    # 600 °/s at 10.5 us a degree: 6300 us/s, so 252 half microseconds in a period of 20 ms.
    steps = [float(n.rstrip('f')) for n in found['STEP_COUNTS'].strip('{}').split(', ')]
    assert steps == pytest.approx([252.0] * 6, rel=1e-6)
    assert (found['ARM_INTERVAL_MS'], found['MINIMUM_BATTERY_MV']) == ('150', '6400')
    assert found['RELEASE_ON_LINK_LOSS'] == '0'


def test_pulses_that_do_not_fit_a_period_are_refused():
    settings = BoardSettings(count_ranges=((1100, 36_001),), count_speeds=(100.0,))
    with pytest.raises(ConfigError, match=r'channel 0 reach 18000\.5 us'):
        header(settings, 250_000, 'wide')


def test_release_on_link_loss_reaches_the_board():
    settings = BoardSettings(count_ranges=((1100, 4900),), count_speeds=(100.0,))
    released = dataclasses.replace(settings, on_link_loss='release')
    assert definitions(header(released, 250_000, 'one'))['RELEASE_ON_LINK_LOSS'] == '1'


@pytest.mark.parametrize('machine', ['robocake', 'arm_6r'])
def test_every_servo_machine_has_a_program_that_fits_a_quarter_of_the_chip(machine):
    sections = firmware_build.sizes(firmware_build.firmware(header_of(machine)))
    assert sections.flash <= 64 * 1024
    # What is left for the stack.
    assert sections.ram <= 8192 - 1024
