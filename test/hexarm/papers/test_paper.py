import numpy as np
import pytest

from hexarm.papers.paper_arm import (
    PaperArm,
    position_rates_factors,
    projection_rates,
    projections,
    wrist_factors,
)

ARM = PaperArm(0.3, 0.4, 0.4)
STEP = 1e-6


@pytest.fixture(scope='module')
def joints():
    return np.random.default_rng(1).uniform(-3, 3, (50, 6))


def slopes(function, q):
    return np.stack(
        [(function(q + e) - function(q - e)) / (2 * STEP) for e in STEP * np.eye(6)], axis=-1
    )


def test_eq_1_is_the_wrist_centre_of_the_shipped_arm(arm_6r, joints):
    tool = arm_6r.chain.forward(joints)
    centre = tool.position - 0.12 * tool.rotation[:, :, 2]
    assert np.abs(ARM.position(joints) - centre).max() < 1e-12


def test_projections_are_those_of_the_tool_axes(arm_6r, joints):
    rotation = arm_6r.chain.forward(joints).rotation
    expected = np.stack([rotation[:, 0, 2], rotation[:, 2, 2], -rotation[:, 2, 1]], axis=-1)
    assert np.abs(projections(joints) - expected).max() < 1e-12


def test_the_printed_sign_of_a_x_contradicts_eq_1():
    q = np.array([0.7, 0.5, 0.6, 0.0, 0.0, 0.0])
    forearm = ARM.position(q) - PaperArm(0.3, 0.4, 1e-9).position(q)
    assert projections(q)[0] == pytest.approx(forearm[0] / 0.4, abs=1e-6)
    assert projections(q)[0] < 0


def test_rates_are_the_derivatives(joints):
    for q in joints:
        assert np.abs(ARM.position_rates(q) - slopes(ARM.position, q)[:, :3]).max() < 1e-8
        assert np.abs(projection_rates(q) - slopes(projections, q)).max() < 1e-8


def test_factors_make_the_determinants(joints):
    for q in joints:
        first = np.linalg.det(slopes(ARM.position, q)[:, :3])
        assert np.prod(list(position_rates_factors(ARM, q).values())) == pytest.approx(
            first / (0.4 * 0.4 * 0.8), abs=1e-7
        )
        last = np.linalg.det(slopes(projections, q)[:, 3:])
        assert np.prod(list(wrist_factors(q).values())) == pytest.approx(last, abs=1e-7)
