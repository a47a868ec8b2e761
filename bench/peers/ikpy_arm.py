"""ikpy: pure Python, least squares by scipy, on the published UR5."""

from importlib.metadata import version

import numpy as np
from ikpy.chain import Chain
from ikpy.link import OriginLink, URDFLink

from bench.peers.arm_library import ArmLibrary, compared
from bench.peers.published_arms import links
from bench.row import Row
from manipulator.arrays import Array


def rows() -> list[Row]:
    place, turn, parts = (0.0, 0.0, 0.0), 0.0, [OriginLink()]
    for k, link in enumerate(links('ur5')):
        parts.append(URDFLink(f'joint_{k + 1}', place, [turn, 0.0, 0.0], rotation=[0, 0, 1]))
        place, turn = link.position, link.alpha
    parts.append(URDFLink('tool', place, [turn, 0.0, 0.0], joint_type='fixed'))
    moves = [False, *[True] * 6, False]
    chain = Chain(parts, active_links_mask=moves)

    def forward(joints: Array) -> Array:
        return chain.forward_kinematics(np.concatenate([[0.0], joints, [0.0]]))

    def inverse(pose: Array, near: Array) -> Array:
        start = np.concatenate([[0.0], near, [0.0]])
        found = chain.inverse_kinematics_frame(pose, start, orientation_mode='all')
        return found[1:7]

    return compared(ArmLibrary(f'ikpy {version("ikpy")}', forward, None, inverse))
