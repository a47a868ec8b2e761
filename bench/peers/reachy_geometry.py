"""Reachy Mini's head, the best known open crank hexapod, as one of our machines.

Nominal dimensions in mm, read off its published kinematics_data.json (github.com/pollen-robotics/
reachy_mini, Apache-2.0), which spells the same machine out to single micrometres.
"""

import numpy as np

from hexapod_control.geometry import JointsConfig
from hexapod_control.leg_limits import RotaryLimits
from hexapod_control.load import rotary_hexapod
from hexapod_control.rotary import RotaryHexapod

PAIRS_DEG = (60.0, 180.0, 300.0)
CRANK_RADIUS, CRANK_SPREAD, CRANK_HEIGHT = 34.911, 10.25, 70.95
JOINT_RADIUS, JOINT_SPREAD, JOINT_HEIGHT = 32.588, 6.5, -1.2
JOINTS_SHIFTED_BY = 8.0  # along x: the head's frame is not in the middle of its joints
CRANK, ROD, HOME_HEIGHT = 38.0, 90.0, 177.0

LIMITS = {
    'crank_range_deg': [100.0, 260.0],  # the maker's ±80°, from our zero
    'minimum_height_mm': 0.0,
    'platform_joint_swing_deg': 180.0,
    'crank_joint_tilt_deg': 90.0,
    'singularity_margin': 0.05,
    'characteristic_length_mm': 34.0,
}


def reachy_mini() -> RotaryHexapod:
    """Our kinematics of it; platform and base frame as the maker's."""
    centres, tangents, joints = [], [], []
    for pair in np.radians(PAIRS_DEG):
        out = np.array([np.cos(pair), np.sin(pair), 0.0])
        along = np.array([-np.sin(pair), np.cos(pair), 0.0])
        for side in (-1.0, 1.0):
            centre = CRANK_RADIUS * out + side * CRANK_SPREAD * along
            joint = JOINT_RADIUS * out + side * JOINT_SPREAD * along
            centres.append([*centre[:2], CRANK_HEIGHT])
            tangents.append((-side * along).tolist())
            joints.append([joint[0] + JOINTS_SHIFTED_BY, joint[1], JOINT_HEIGHT])
    geometry = {
        'crank_centres_mm': centres,
        'crank_tangents': tangents,
        'platform_joints_mm': joints,
        'crank_length_mm': CRANK,
        'rod_length_mm': ROD,
        'home_height_mm': HOME_HEIGHT,
    }
    return rotary_hexapod(JointsConfig(**geometry), RotaryLimits(**LIMITS))[0]
