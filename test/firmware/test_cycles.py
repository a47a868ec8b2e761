"""The board's own kinematics fit its period, and the arm's step the paper's bound."""

from firmware.simulator.chip import CLOCK_HZ
from firmware.simulator.cycles import ARM_STEP, INVERSE, KERNEL_STEP, costs

PERIOD = CLOCK_HZ // 50


def test_one_inverse_takes_less_than_half_a_pulse_period():
    assert costs()[INVERSE].longest < PERIOD / 2


def test_an_arm_step_takes_less_than_the_20_ms_of_the_paper():
    found = costs()
    assert found[ARM_STEP].longest < PERIOD
    assert found[KERNEL_STEP].longest < PERIOD
