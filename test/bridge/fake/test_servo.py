import numpy as np

from bridge.fake.servo import Servos


def servos(**changes):
    settings = {'start': [0.0, 0.0], 'speed': 10.0, 'dead_band': 0.0, 'hysteresis': 0.0}
    return Servos.at_rest(**(settings | changes))


def settle(machine, target):
    for _ in range(200):
        machine.step(np.array(target), 0.005)
    return machine.positions.tolist()


def test_turns_at_rated_speed_and_no_faster():
    machine = servos()
    machine.step(np.array([1.0, -1.0]), 0.01)
    assert np.allclose(machine.positions, [0.1, -0.1])
    assert np.allclose(settle(machine, [1.0, -1.0]), [1.0, -1.0])


def test_without_pulses_it_stays():
    machine = servos(start=[0.3, 0.4])
    assert settle(machine, [np.nan, 0.5]) == [0.3, 0.5]


def test_reversal_loses_the_hysteresis():
    machine = servos(hysteresis=0.02)
    up = settle(machine, [0.5, 0.5])
    down = settle(machine, [0.49, 0.3])
    assert np.allclose(up, [0.49, 0.49])
    assert np.allclose(down, [0.49, 0.31])


def test_errors_within_the_dead_band_move_nothing():
    machine = servos(dead_band=0.01)
    assert settle(machine, [0.0049, 0.0051]) == [0.0, 0.0051]
