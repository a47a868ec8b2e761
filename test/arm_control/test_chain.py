import numpy as np

from arm_control.geometry import DhConfig, ScrewsConfig
from manipulator import rotation as so3
from manipulator.config import build


def test_paper_arm_turns_by_the_papers_product_of_rotations(arm_6r):
    for q in np.random.default_rng(3).uniform(-3, 3, (50, 6)):
        expected = np.eye(3)
        for axis, angle in zip('zxxzxz', q * (1, -1, -1, 1, -1, 1), strict=True):
            expected = expected @ so3.exp(angle * np.eye(3)['xyz'.index(axis)])
        assert np.abs(arm_6r.chain.forward(q).rotation - expected).max() < 1e-12


def test_jacobian_agrees_with_finite_differences(arm):
    step = 1e-6
    for q in np.random.default_rng(4).uniform(arm.limits.low, arm.limits.high, (30, 6)):
        jacobian = arm.chain.jacobian(q)
        for joint in range(6):
            nudge = step * np.eye(6)[joint]
            before, after = arm.chain.forward(q - nudge), arm.chain.forward(q + nudge)
            measured = before.twist_to(after) / (2 * step)
            assert np.abs(jacobian[:, joint] - measured).max() < 1e-8


def test_arrays_of_joints_give_what_each_alone_gives(arm):
    q = np.random.default_rng(5).uniform(-3, 3, (2, 3, 6))
    poses, jacobians = arm.chain.forward(q), arm.chain.jacobian(q)
    for index in np.ndindex(2, 3):
        alone = arm.chain.forward(q[index])
        assert np.array_equal(poses[index].position, alone.position)
        assert np.abs(jacobians[index] - arm.chain.jacobian(q[index])).max() < 1e-15


def test_screws_with_axes_of_any_length_make_the_same_arm(arm):
    chain = arm.chain
    points = chain.points + 0.1 * chain.axes
    content = {
        'screws': [
            {'axis': (2 * a).tolist(), 'point_mm': (1e3 * p).tolist()}
            for a, p in zip(chain.axes, points, strict=True)
        ],
        'tool_position_mm': (1e3 * chain.home.position).tolist(),
        'tool_rpy_deg': np.degrees(chain.home.rpy).tolist(),
        'home_deg': [0.0] * 6,
    }
    same = build(ScrewsConfig, content).chain()
    q = np.random.default_rng(6).uniform(-3, 3, (20, 6))
    assert np.abs(chain.forward(q).twist_to(same.forward(q))).max() < 1e-8


def test_a_tool_on_a_dh_table_lies_along_the_last_z_axis(machine_file):
    geometry = machine_file('ur5').geometry
    bare = build(DhConfig, geometry).chain()
    tooled = build(DhConfig, {**geometry, 'tool_mm': 150.0}).chain()
    q = np.random.default_rng(7).uniform(-3, 3, 6)
    in_flange = bare.forward(q).inverse() @ tooled.forward(q)
    assert np.abs(in_flange.position - [0.0, 0.0, 0.15]).max() < 1e-12
    assert np.abs(in_flange.rotation - np.eye(3)).max() < 1e-12
