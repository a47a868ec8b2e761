"""roboticstoolbox-python: elementary transforms with compiled kernels, on the published UR5."""

from importlib.metadata import version

import roboticstoolbox as rtb

from bench.peers.arm_library import ArmLibrary, compared
from bench.peers.published_arms import links
from bench.row import Row
from manipulator.arrays import Array

TOLERANCE = 1e-12  # of half the squared error: a micrometre; its default leaves a millimetre


def rows() -> list[Row]:
    chain = rtb.ETS()
    for k, link in enumerate(links('ur5')):
        x, _, z = link.position
        chain *= rtb.ET.Rz(jindex=k) * rtb.ET.tz(z) * rtb.ET.tx(x) * rtb.ET.Rx(link.alpha)

    def inverse(pose: Array, near: Array) -> Array:
        return chain.ik_LM(pose, q0=near, tol=TOLERANCE)[0]

    name = f'roboticstoolbox {version("roboticstoolbox-python")}'
    return compared(ArmLibrary(name, chain.eval, chain.jacob0, inverse))
