"""parameters.h: the machine file stays the one source."""

import dataclasses
import re
from pathlib import Path

import pytest

from bridge.calibration import COUNTS_PER_US, Calibration
from bridge.fake.board_settings import BoardSettings
from bridge.servo_config import BoardConfig
from hexarm import machines
from hexarm.board import build as firmware_build
from hexarm.board.header import CHANNELS, WIDEST_COUNT, header, header_of
from hexarm.cli.main import main
from manipulator.errors import ConfigError


def definitions(text):
    return dict(re.findall(r'^    \.(\w+) = (.+), \\$', text, re.MULTILINE))


def test_every_number_comes_from_the_machine_file(capsys):
    assert main(['firmware-header', 'robocake']) == 0
    found = definitions(capsys.readouterr().out)
    config = BoardConfig.from_machine(machines.read('robocake'))
    ranges = Calibration.from_config(config.servos).count_ranges
    assert found['joint_count'] == '6'
    assert found['baud'] == '250000'
    unused = ', 0, 0}'
    assert found['lowest_counts'] == '{' + ', '.join(str(low) for low, _ in ranges) + unused
    assert found['highest_counts'] == '{' + ', '.join(str(high) for _, high in ranges) + unused
    # 600 °/s at 10.5 us a degree: 6300 us/s, so 252 half microseconds in a period of 20 ms.
    steps = [float(n.rstrip('f')) for n in found['step_counts'].strip('{}').split(', ')]
    assert steps == pytest.approx([252.0] * 6 + [0.0] * 2, rel=1e-6)
    assert (found['arm_interval_ms'], found['minimum_battery_mv']) == ('150', '6400')
    assert found['releases_on_link_loss'] == 'false'


def test_pulses_that_do_not_fit_a_period_are_refused():
    settings = BoardSettings(count_ranges=((1100, 36_001),), count_speeds=(100.0,))
    with pytest.raises(ConfigError, match=r'channel 0 reach 18000\.5 us'):
        header(settings, 'wide')


@pytest.mark.parametrize('baud', [57_600, 115_200, 250_000, 1_000_000, 2_000_000])
def test_rates_that_the_chip_comes_near_to_are_taken(baud):
    settings = BoardSettings(((1100, 4900),), (100.0,), baud=baud)
    assert definitions(header(settings, 'one'))['baud'] == str(baud)


@pytest.mark.parametrize('baud', [230_400, 460_800, 1_500_000, 4_000_000])
def test_a_rate_that_the_chip_cannot_make_is_refused(baud):
    settings = BoardSettings(((1100, 4900),), (100.0,), baud=baud)
    with pytest.raises(ConfigError, match=f'link.baud: {baud} bit/s; the board makes'):
        header(settings, 'one')


def test_a_battery_that_the_board_cannot_measure_is_refused():
    settings = BoardSettings(((1100, 4900),), (100.0,), minimum_battery_mv=11_100)
    with pytest.raises(ConfigError, match=r'minimum_battery_v: 11\.1 V, the board measures below'):
        header(settings, 'one')


def test_release_on_link_loss_reaches_the_board():
    settings = BoardSettings(count_ranges=((1100, 4900),), count_speeds=(100.0,))
    released = dataclasses.replace(settings, on_link_loss='release')
    assert definitions(header(released, 'one'))['releases_on_link_loss'] == 'true'


@pytest.mark.parametrize('machine', ['robocake', 'arm_6r'])
def test_every_servo_machine_has_a_program_that_fits_a_quarter_of_the_chip(machine):
    sections = firmware_build.sizes(firmware_build.firmware(header_of(machine)))
    assert sections.flash <= 64 * 1024
    # What is left for the stack.
    assert sections.ram <= 8192 - 1024


def test_more_joints_than_the_chip_has_channels_are_refused():
    with pytest.raises(ConfigError, match='18 joints, the board has 8 channels'):
        header_of('stack_6_6')


def test_the_page_of_actuators_tells_what_the_board_emits():
    root = Path(__file__).parents[2]
    page = (root / 'docs' / 'actuators.md').read_text()
    assert (CHANNELS, WIDEST_COUNT / COUNTS_PER_US, COUNTS_PER_US) == (8, 18_000, 2)
    for words in ('eight outputs', 'at most 18 ms', 'steps of half a microsecond'):
        assert words in page
    for name in ('README.md', 'docs/wiring.md'):
        assert 'actuators.md' in (root / name).read_text()
    with pytest.raises(ConfigError, match='reach'):  # "its counts do not fit a pulse"
        header_of('arm_6r_stepper')
