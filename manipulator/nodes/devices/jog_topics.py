"""What every node of a person's input device sends: twists, mode, gripper, home, stop, save.

A twist means that the deadman is held. Releasing it publishes one zero and then nothing, so that
a release and a node that has died are the same for the trajectory node.

The stop button brakes along the path; where that is not confirmed, it becomes the emergency stop.
Braking is gentler, and the machine can go on afterwards. But the trajectory node cannot brake what
it does not drive (a program that the board plays by itself), nor when it hangs or has died.
"""

import time

from geometry_msgs.msg import TwistStamped
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.task import Future
from std_msgs.msg import Bool, Float64, String
from std_srvs.srv import Trigger

from manipulator.arrays import Array, frozen
from manipulator.deadlines import HAND_OVER, RELEASE
from manipulator.nodes.qos import COMMAND, EVERY_WORD, LATCHED

LATCHED_BY = 'EMERGENCY STOP, because {}: serial_bridge/clear_fault ends it'
NO_SUBSCRIBER = 'no subscriber on emergency_stop: switch off the servo supply'


class StopButton:
    """Calls `trajectory/stop`, and publishes `emergency_stop` where that fails or is not answered.

    `watch` must be called at every tick.
    """

    def __init__(self, node: Node) -> None:
        self._node = node
        self._asked_at: float | None = None
        self._client = node.create_client(Trigger, 'trajectory/stop')
        self._stops = node.create_publisher(Bool, 'emergency_stop', EVERY_WORD)

    def press(self) -> None:
        """Stops all motion."""
        if not self._client.service_is_ready():
            self._stop_at_once('no trajectory node answers')
            return
        if self._asked_at is None:
            self._asked_at = time.monotonic()
        self._client.call_async(Trigger.Request()).add_done_callback(self._hear)

    def watch(self) -> None:
        """Loses patience with a trajectory node that does not answer."""
        if self._asked_at is not None and time.monotonic() - self._asked_at > RELEASE:
            self._stop_at_once(f'the trajectory node did not answer within {RELEASE:g} s')

    def close(self, patience: Duration) -> None:
        """Waits until all subscribers have received it: then the publisher may end."""
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
            self._node.get_logger().error(NO_SUBSCRIBER)


NO_TWIST = frozen([0.0] * 6)


HALF_OPEN = 0.5
"""Of a gripper that has not been moved yet: where a machine parks it."""

LAST_WORD = Duration(seconds=0.5)
"""How long to wait for a subscriber that does not answer."""


class JogTopics:
    """The publishers and service clients of one source of twists, cmd_vel/`source`."""

    def __init__(self, node: Node, source: str) -> None:
        self._node = node
        self._is_moving = False
        self._last_twist = float('-inf')
        self._is_homing = False
        self._is_home_asked = False
        self._mode = ''
        self._opening = HALF_OPEN
        self._twists = node.create_publisher(TwistStamped, f'cmd_vel/{source}', COMMAND)
        self._modes = node.create_publisher(String, 'jog_mode', LATCHED)
        self._gripper = node.create_publisher(Float64, 'gripper', LATCHED)
        node.create_subscription(Float64, 'gripper', self._on_gripper, LATCHED)
        self._stop_button = StopButton(node)
        self._services = {
            name: node.create_client(Trigger, name)
            for name in ('trajectory/home', 'trajectory/stop', 'pose/save')
        }

    def drive(self, twist: Array, frame: str, is_held: bool) -> None:
        """Sends the twist (6,), or the one zero at release, or nothing; call at every tick."""
        self._stop_button.watch()
        if is_held or self._is_moving:
            message = TwistStamped()
            message.header.stamp = self._node.get_clock().now().to_msg()
            message.header.frame_id = frame
            numbers = twist.tolist() if is_held else [0.0] * 6
            linear, angular = message.twist.linear, message.twist.angular
            linear.x, linear.y, linear.z, angular.x, angular.y, angular.z = numbers
            self._twists.publish(message)
            self._last_twist = time.monotonic()
        self._is_moving = is_held

    def choose(self, mode: str) -> None:
        """Publishes the jog mode when it is another."""
        if mode != self._mode:
            self._mode = mode
            self._modes.publish(String(data=mode))

    def grip(self, step: float) -> None:
        """Opens the gripper by `step` of its range, or closes it for negative ones."""
        opening = min(max(self._opening + step, 0.0), 1.0)
        if opening != self._opening:
            self.open_to(opening)

    def open_to(self, opening: float) -> None:
        """Opens the gripper to a share of its range, 0 (closed) to 1."""
        self._opening = opening
        self._gripper.publish(Float64(data=opening))

    def home(self, is_held: bool) -> None:
        """Goes home while held: calls once the machine is free, and stops it at release."""
        if self._is_homing and not is_held and self._is_home_asked:
            self._ask('trajectory/stop')
        self._is_home_asked &= is_held
        self._is_homing = is_held
        is_free = time.monotonic() - self._last_twist > HAND_OVER
        if is_held and is_free and not self._is_home_asked:
            self._is_home_asked = True
            self._ask('trajectory/home')

    def go_home(self) -> None:
        """Calls `trajectory/home`, however long that takes."""
        self._ask('trajectory/home')

    def save_pose(self) -> None:
        """Calls `pose/save`: the pose is saved under the next free name."""
        self._ask('pose/save')

    def stop(self) -> None:
        """Stops all motion: by braking if possible, else at once."""
        self._stop_button.press()

    @property
    def has_subscribers(self) -> bool:
        """Whether a trajectory node is there, and takes the twists."""
        is_there = bool(self._services['trajectory/stop'].service_is_ready())
        return is_there and bool(self._twists.get_subscription_count() > 0)

    @property
    def is_moving(self) -> bool:
        """Whether twists are sent."""
        return self._is_moving

    def close(self) -> None:
        """Releases, and waits until all subscribers have received that."""
        self.home(False)
        self.drive(NO_TWIST, '', False)
        self._twists.wait_for_all_acked(LAST_WORD)
        self._stop_button.close(LAST_WORD)

    def _ask(self, name: str) -> None:
        client = self._services[name]
        if not client.service_is_ready():
            node = name.partition('/')[0]
            self._node.get_logger().warning(f'{name}: no {node} node answers')
            return
        client.call_async(Trigger.Request()).add_done_callback(
            lambda future: self._say(name, future)
        )

    def _say(self, name: str, future: Future) -> None:
        answer = future.result()
        logger = self._node.get_logger()
        (logger.info if answer.success else logger.warning)(f'{name}: {answer.message}')

    def _on_gripper(self, message: Float64) -> None:
        if 0.0 <= message.data <= 1.0:
            self._opening = message.data
