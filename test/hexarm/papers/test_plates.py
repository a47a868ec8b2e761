"""φb = φmp: the legs do not determine the pose; other angles do."""

import numpy as np
import pytest

from hexarm.papers.plates import TARGET, Plates, leg_slopes, same_legs


@pytest.mark.parametrize('degrees', [10.0, 20.0, 30.0, 47.0])
def test_equal_angles_let_the_platform_move_while_no_leg_changes(degrees):
    plates = Plates(degrees, degrees)
    other = same_legs(plates, np.radians(5.0))
    assert np.linalg.norm(TARGET.twist_to(other)[3:]) == pytest.approx(np.radians(5.0))
    assert np.abs(plates.lengths(other) - plates.lengths(TARGET)).max() < 1e-12
    assert plates.solvable_steps() == 1


def test_the_paper_s_method_finds_the_way_with_regular_angles():
    plates = Plates(50.0, 10.0)
    assert plates.solvable_steps() == 101
    last = plates.motion()[-1]
    assert last.residual < 1e-12
    assert np.abs(TARGET.twist_to(last.pose)).max() < 1e-9


def test_slopes_are_the_derivatives_of_the_lengths():
    plates, step = Plates(50.0, 10.0), 1e-7
    for column, unit in zip(leg_slopes(plates, TARGET).T, np.eye(6), strict=True):
        ends = [plates.lengths(TARGET.moved(sign * step * unit)) for sign in (1, -1)]
        assert (ends[0] - ends[1]) / (2 * step) == pytest.approx(column, abs=1e-6)
