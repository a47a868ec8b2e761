import numpy as np

from bridge.fake.servo import Steppers


def steppers(**changes):
    settings = {'start': [0.0, 0.0], 'speed': 10.0, 'dead_band': 0.0, 'hysteresis': 0.0}
    return Steppers.at_rest(**(settings | changes))


def test_all_joints_come_along_one_line_and_arrive_together():
    machine = steppers()
    for _ in range(3):
        machine.step(np.array([0.5, -0.1]), 0.01)
        assert np.isclose(machine.positions[1], -0.2 * machine.positions[0])
    assert np.allclose(machine.positions, [0.3, -0.06])
    machine.step(np.array([0.5, -0.1]), 1.0)
    assert machine.positions.tolist() == [0.5, -0.1]


def test_a_drive_without_steps_stays_and_holds_up_no_other():
    machine = steppers(start=[0.3, 0.4])
    machine.step(np.array([np.nan, 0.5]), 0.02)
    assert machine.positions.tolist() == [0.3, 0.5]
