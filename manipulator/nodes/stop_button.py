"""A person's stop button: brakes along the way; where nobody confirms it, the emergency stop.

Braking is gentler, and the machine can go on afterwards. But the trajectory node cannot brake what
it does not drive (a program that the board plays by itself), nor when it hangs or has died.
"""

import time

from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.task import Future
from std_msgs.msg import Bool
from std_srvs.srv import Trigger

from manipulator.nodes.qos import EVERY_WORD

PATIENCE = 0.25
"""Seconds in which the trajectory node must say that it brakes."""

LATCHED_BY = 'EMERGENCY STOP, because {}: serial_bridge/clear_fault ends it'
UNHEARD = 'nobody hears emergency_stop: switch off the supply of the servos'


class StopButton:
    """Asks `trajectory/stop`, and publishes `emergency_stop` where that fails or is not answered.

    `watch` must be called at every tick.
    """

    def __init__(self, node: Node) -> None:
        self._node = node
        self._asked_at: float | None = None
        self._client = node.create_client(Trigger, 'trajectory/stop')
        self._stops = node.create_publisher(Bool, 'emergency_stop', EVERY_WORD)

    def press(self) -> None:
        """Stops whatever moves."""
        if not self._client.service_is_ready():
            self._stop_at_once('no trajectory node answers')
            return
        if self._asked_at is None:
            self._asked_at = time.monotonic()
        self._client.call_async(Trigger.Request()).add_done_callback(self._hear)

    def watch(self) -> None:
        """Loses patience with a trajectory node that does not answer."""
        if self._asked_at is not None and time.monotonic() - self._asked_at > PATIENCE:
            self._stop_at_once(f'the trajectory node did not answer within {PATIENCE:g} s')

    def close(self, patience: Duration) -> None:
        """Waits until everybody has heard it: then the publisher may vanish."""
        if self._asked_at is not None:
            self._stop_at_once('this node ends before the trajectory node has answered')
        self._stops.wait_for_all_acked(patience)

    def _hear(self, future: Future) -> None:
        answer = future.result()
        if answer.success:
            self._asked_at = None
            self._node.get_logger().info(f'stop: {answer.message}')
        else:
            self._stop_at_once(answer.message)

    def _stop_at_once(self, reason: str) -> None:
        self._asked_at = None
        self._stops.publish(Bool(data=True))
        self._node.get_logger().error(LATCHED_BY.format(reason))
        if self._stops.get_subscription_count() == 0:
            self._node.get_logger().error(UNHEARD)
