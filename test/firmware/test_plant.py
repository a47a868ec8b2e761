"""The program on the simulated chip moves rigid bodies, as the one on this computer does."""

import numpy as np
import pytest

from bridge.fake.board import Board
from bridge.frames import encode
from bridge.protocol import Arm, Setpoint
from firmware.simulator.board import SimulatedBoard
from hexarm import machines
from hexarm.board.plant import fake_machine

CONFIG = machines.board_config('robocake')
KINEMATICS = machines.load('robocake').kinematics
UP = np.array([0.0, 0.0, 6e-3, 0.0, 0.0, 0.0])
STEP = 0.01


def height(machine):
    """Of the platform that the joints hold."""
    return KINEMATICS.forward(machine.servos.positions[:6]).pose.position[2]


def heights(make_board):
    """Of a platform that is armed, lifted by 6 mm and left alone, in steps of STEP."""
    machine = fake_machine(
        'robocake', CONFIG, 0.0, 0.0, 'mujoco', lambda text: None, make_board=make_board
    )
    park = machine.calibration.counts(machine.calibration.park)
    lifted = machine.calibration.counts(KINEMATICS.inverse(KINEMATICS.home.moved(UP)))
    found, sequence = [], 1
    machine.board.step(STEP)
    machine.board.feed(encode(Arm(park), sequence))
    for k in range(300):
        if k >= 150 and k % 10 == 0:
            sequence += 1
            machine.board.feed(encode(Setpoint(200, lifted), sequence))
        machine.step(STEP)
        found.append(height(machine))
    return np.array(found)


def test_the_chip_lifts_the_loaded_platform_as_the_computers_board_does(chip_tools):
    ours, chips = heights(Board), heights(SimulatedBoard)
    home = KINEMATICS.home.position[2]
    assert chips[140] == pytest.approx(home, abs=1e-3)
    assert chips[-1] == pytest.approx(home + UP[2], abs=1e-3)
    assert chips[-1] < home + UP[2]
    assert np.abs(ours[-50:] - chips[-50:]).max() < 1e-4
