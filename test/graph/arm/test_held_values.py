"""What a jog mode holds stays held while the arm moves, at the end and all the way."""

import numpy as np
import pytest

from hexarm.machines import load

pytestmark = [pytest.mark.graph, pytest.mark.real_time]

HOME = load('arm_6r_stepper').kinematics.home


def check_held(what, errors, bound, unit):
    """At the end and at every moment on the way; the figures are printed."""
    end, rms, worst = errors[-1], np.sqrt(np.mean(np.square(errors))), max(errors)
    figures = ', '.join(f'{v:.3f}{unit}' for v in (end, rms, worst))
    print(f'{what}: error at the end, rms, max {figures}')
    assert worst < bound, figures


def test_held_orientation_stays_within_a_tenth_of_a_degree_over_a_metre(arm, joystick, listen):
    joystick.mode('hold_orientation')
    heard = listen()
    for vx in (0.2, -0.2, 0.2):
        joystick.hold([vx, 0, 0, 0, 0, 0], 1.5 if vx > 0 else 3.0)
    poses = heard.poses
    way = np.linalg.norm(np.diff([p.position for p in poses], axis=0), axis=1).sum()
    assert way > 0.9
    turned = [np.degrees(np.linalg.norm(poses[0].twist_to(pose)[3:])) for pose in poses]
    check_held('orientation', turned, 0.1, '°')


def test_turning_holds_the_tool_point_within_half_a_millimetre(arm, joystick, listen):
    joystick.mode('turn_base_z')
    heard = listen()
    for wz in (0.5, -0.5):
        joystick.hold([0, 0, 0, 0, 0, wz], 1.5)
    poses = heard.poses
    assert max(np.linalg.norm(poses[0].twist_to(p)[3:]) for p in poses) > 0.5
    shifts = [1e3 * np.linalg.norm(poses[0].twist_to(p)[:3]) for p in poses]
    check_held('tool point', shifts, 0.5, ' mm')


def test_look_at_keeps_pointing_at_one_point_while_moving(arm, joystick, listen):
    point = HOME.position + 0.3 * HOME.rotation[:, 2]
    joystick.mode('look_at', point)
    heard = listen()
    joystick.hold([0.1, 0, 0, 0, 0, 0], 1.5)
    joystick.send()
    missed = [np.linalg.norm(np.cross(p.rotation[:, 2], point - p.position)) for p in heard.poses]
    check_held('sight', [1e3 * m for m in missed], 0.5, ' mm')
    assert heard.poses[-1].position[0] - heard.poses[0].position[0] > 0.1
