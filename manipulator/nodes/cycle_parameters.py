"""The parameters of `~/start_cycle`: six amplitudes, frequencies and phases a term."""

import numpy as np
from rclpy.node import Node

from manipulator.arrays import Array
from manipulator.nodes.parameters import declare
from manipulator.pose import Pose
from manipulator.trajectory.cycle import Cycle

AXES = 'x, y, z, roll, pitch, yaw; further terms follow as further six'
AMPLITUDE = [0.003, 0.003, 0.0015, 0.05, 0.05, 0.04]
"""Half of the amplitudes of Prokopovich 2019, fig. 12, whose own corners are out of reach."""


class CycleParameters:
    """cycle.amplitude, cycle.frequency and cycle.phase; read when a cycle is started."""

    def __init__(self, node: Node) -> None:
        self._node = node
        defaults = {
            'amplitude': (AMPLITUDE, f'amplitudes (m, rad) about {AXES}'),
            'frequency': ([0.5] * 6, f'frequencies (Hz) about {AXES}'),
            'phase': ([0.0] * 6, f'phases (rad) about {AXES}'),
        }
        for name, (default, description) in defaults.items():
            declare(node, f'cycle.{name}', default, description, is_read_only=False)

    def read(self, centre: Pose) -> Cycle:
        """The cycle about `centre`; InvalidInput says what does not fit."""
        amplitude, frequency, phase = map(self._terms, ('amplitude', 'frequency', 'phase'))
        return Cycle(centre, amplitude, frequency, phase)

    def _terms(self, name: str) -> Array:
        values = np.array(self._node.get_parameter(f'cycle.{name}').value, dtype=np.float64)
        return values.reshape(-1, 6) if values.size % 6 == 0 else values
