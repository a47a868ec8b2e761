"""The fake board's plant in MuJoCo: lag, load, stalls, and drives without power."""

import re

import numpy as np
import pytest

from bridge.calibration import Calibration
from bridge.fake.servo import Servos
from bridge.servo_config import BoardConfig
from hexarm.board.plant import fake_machine
from hexarm.simulation.model import mechanism
from hexarm.simulation.plant import MujocoPlant
from manipulator.errors import InvalidInput


def plant_of(this, **changes):
    calibration = Calibration.from_config(BoardConfig.from_machine(this.file).servos)
    model = mechanism(this.name, this.file, this.kinematics, **changes)
    park = calibration.park
    return MujocoPlant(model, this.kinematics, calibration.names, park), park


def after(plant_, targets, seconds):
    for _ in range(round(seconds / 0.01)):
        plant_.step(targets, 0.01)
    return plant_.positions


@pytest.mark.parametrize('name', ['robocake', 'stewart_6_6', 'arm_6r'])
def test_targets_are_reached_but_for_what_the_load_takes(example, name):
    moved, park = plant_of(example(name))
    k = example(name).kinematics
    targets = park.copy()
    targets[:6] = k.inverse(
        k.forward(park[:6]).pose.moved(np.array([2e-3, 1e-3, 2e-3, 0, 0, 0.02]))
    )
    positions = after(moved, targets, 1.0)
    miss = np.abs(positions[:6] - targets[:6]) / moved.simulation.mechanism.drives.band
    assert 1e-4 < miss.max() < 0.5
    assert np.array_equal(positions[6:], targets[6:])


def test_positions_lag_while_servos_run(example):
    moved, park = plant_of(example('robocake'))
    k = example('robocake').kinematics
    targets = k.inverse(k.home.moved(np.array([0, 0, 8e-3, 0, 0, 0])))
    soon = after(moved, targets, 0.02)
    speed = np.abs(soon - park).max() / 0.02
    assert np.abs(soon - targets).max() > 0.1
    assert 1.0 < speed <= np.radians(600)


def test_an_overload_stalls_and_sinks(example):
    light, park = plant_of(example('robocake'))
    heavy, _ = plant_of(example('robocake'), payload_g=4000.0)
    height = example('robocake').kinematics.home.position[2]
    for each in (light, heavy):
        after(each, park, 1.0)
    assert abs(height - light.simulation.pose.position[2]) < 5e-4
    assert height - heavy.simulation.pose.position[2] > 0.01


def test_without_pulses_the_gears_hold_a_light_load_only(example):
    none = np.full(6, np.nan)
    light, park = plant_of(example('robocake'))
    heavy, _ = plant_of(example('robocake'), payload_g=1500.0)
    assert np.abs(after(light, none, 0.5) - park).max() < np.radians(2)
    assert np.abs(after(heavy, none, 0.5) - park).max() > np.radians(10)


def test_time_that_was_missed_is_not_made_up_for(example):
    moved, park = plant_of(example('robocake'))
    moved.step(park, 5.0)
    assert moved.simulation.state.time == pytest.approx(0.05)
    for _ in range(10):
        moved.step(park, 0.0003)
    assert moved.simulation.state.time == pytest.approx(0.053, abs=0.0006)


def test_the_fake_board_gets_it_by_name_and_reports_its_speed(example):
    config = BoardConfig.from_machine(example('robocake').file)
    received = []
    fake = fake_machine('robocake', config, 0.0, 0.0, 'servo', received.append)
    assert isinstance(fake.servos, Servos)
    moved = fake_machine('robocake', config, 0.0, 0.0, 'mujoco', received.append)
    for _ in range(210):
        moved.step(0.05)
    assert re.fullmatch(r'mujoco: \d+ times as fast as real time', received[0])
    with pytest.raises(InvalidInput, match="plant: 'gazebo' is not one of"):
        fake_machine('robocake', config, 0.0, 0.0, 'gazebo', received.append)
