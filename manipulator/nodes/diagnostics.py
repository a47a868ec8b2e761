"""A node's report on /diagnostics, once a second (REP-107)."""

from collections.abc import Callable, Mapping, Sequence

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from rclpy.node import Node
from rclpy.qos import QoSProfile

from manipulator.nodes.graph_check import Received, crowds, received_by, unreceived
from manipulator.nodes.steady_timer import SteadyTimer

OK, WARN, ERROR = DiagnosticStatus.OK, DiagnosticStatus.WARN, DiagnosticStatus.ERROR

Report = tuple[bytes, str, Mapping[str, object]]
"""Level, message, and the values people need."""


def status(
    level: bytes, name: str, message: str, values: Mapping[str, object]
) -> DiagnosticStatus:
    """A DiagnosticStatus; numbers are written with four significant digits."""
    pairs = [KeyValue(key=key, value=_text(value)) for key, value in values.items()]
    return DiagnosticStatus(level=level, name=name, message=message, values=pairs)


class Diagnostics:
    """Publishes what `report` returns, and what is wrong with the publishers that feed the node.

    single_publisher: topics that must not have two. received_beside: topics that are received for
    the node, but not by its own subscriptions.
    """

    def __init__(
        self,
        node: Node,
        report: Callable[[], Report],
        single_publisher: Sequence[str] = (),
        received_beside: Sequence[Received] = (),
    ) -> None:
        self._node = node
        self._report = report
        self._single_publisher = single_publisher
        self._received_beside = received_beside
        self._publisher = node.create_publisher(
            DiagnosticArray, '/diagnostics', QoSProfile(depth=10)
        )
        self._timer = SteadyTimer(node, 1.0, self._publish)

    def _publish(self) -> None:
        level, message, values = self._report()
        problems = self._graph_problems()
        if problems:
            self._node.get_logger().warning(problems, throttle_duration_sec=5.0)
            level, message = max(level, WARN), f'{message}; {problems}' if message else problems
        name = self._node.get_fully_qualified_name().lstrip('/')
        stamp = self._node.get_clock().now().to_msg()
        report = status(level, name, message, values)
        if self._node.has_parameter('machine'):
            report.hardware_id = str(self._node.get_parameter('machine').value)
        array = DiagnosticArray(status=[report])
        array.header.stamp = stamp
        self._publisher.publish(array)

    def _graph_problems(self) -> str:
        received = [*received_by(self._node), *self._received_beside]
        found = crowds(self._node, self._single_publisher) + unreceived(self._node, received)
        return '; '.join(found)


def _text(value: object) -> str:
    return f'{value:.4g}' if isinstance(value, float) else str(value)
