"""What the demonstration records: true joint angles, and what was commanded when."""

from typing import TYPE_CHECKING

import numpy as np
from sensor_msgs.msg import JointState

from hexarm.demo.report import Curve, Observation
from manipulator.kinematics import Kinematics
from manipulator.nodes.messages import joints_of, seconds
from manipulator.nodes.qos import MEASUREMENT
from manipulator.pose import Pose

if TYPE_CHECKING:
    from hexarm.client import Client


class Recorder:
    """Everything that the fake board's joints really did, and their commands."""

    def __init__(self, client: 'Client') -> None:
        self._client = client
        self._messages: list[JointState] = []
        self._corners: list[tuple[float, Pose]] = []
        self._curve: Curve | None = None
        client.node.create_subscription(
            JointState, 'true_joint_states', self._messages.append, MEASUREMENT
        )

    def line_to(self, goal: Pose) -> None:
        """Notes that a straight move to `goal` is commanded now."""
        now = seconds(self._client.node.get_clock().now().to_msg())
        self._corners.append((now, goal))

    def follow(self, curve: Curve) -> None:
        """Notes that a curve is commanded."""
        self._curve = curve

    def observation(self, kinematics: Kinematics) -> Observation:
        """All of it as numbers, with the nodes' own figures from /diagnostics."""
        self._client.spin(1.1)
        if self._curve is None or not self._messages:
            raise RuntimeError('nothing was recorded')
        names = kinematics.joint_names
        return Observation(
            times=np.array([seconds(m.header.stamp) for m in self._messages]),
            joints=np.array([joints_of(m, names) for m in self._messages]),
            corners=tuple(self._corners),
            curve=self._curve,
            bridge=self._values('serial_bridge'),
            goals_refused=int(self._values('trajectory').get('goals_refused', 0)),
        )

    def _values(self, node: str) -> dict[str, str]:
        found = [d for name, d in self._client.diagnostics.items() if name.endswith(node)]
        return {pair.key: pair.value for entry in found for pair in entry.values}
