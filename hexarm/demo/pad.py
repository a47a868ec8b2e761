"""A gamepad played by a script: Joy messages as an Xbox pad sends them, for joy_teleop."""

from typing import TYPE_CHECKING

from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import Joy

if TYPE_CHECKING:
    from hexarm.client import Client

PERIOD = 0.02
AXES, BUTTONS = 8, 11
TRIGGERS = (2, 5)
DEADMAN = 4
CROSS = 6
FORWARD, LEFT, UP = 1, 0, 4
"""Axes of the sticks, by what they move in config/joystick_xbox.yaml."""
TREMBLE = 0.01
"""A hand is never still; a pad that sends the same for 0.2 s counts as frozen."""


class ScriptedPad:
    """Publishes while it spins the client; the deadman is held during `drive`."""

    def __init__(self, client: 'Client') -> None:
        self._client = client
        self._count = 0
        self._publisher = client.node.create_publisher(Joy, 'joy', qos_profile_sensor_data)
        client.wait('joy_teleop', lambda: self._publisher.get_subscription_count() > 0, 10.0)
        self.rest(0.2)

    def rest(self, seconds: float) -> None:
        """Nobody touches the pad."""
        self._play(seconds, {}, is_held=False)

    def drive(self, seconds: float, **sticks: float) -> None:
        """The deadman held, and `forward`, `left`, `up` pushed that far (−1 to 1)."""
        axes = {'forward': FORWARD, 'left': LEFT, 'up': UP}
        self._play(seconds, {axes[name]: value for name, value in sticks.items()}, is_held=True)

    def next_mode(self, presses: int) -> None:
        """Presses the cross to the right, or to the left where `presses` is negative."""
        for _ in range(abs(presses)):
            self._play(0.1, {CROSS: -1.0 if presses > 0 else 1.0}, is_held=False)
            self.rest(0.1)

    def _play(self, seconds: float, pushed: dict[int, float], is_held: bool) -> None:
        for _ in range(round(seconds / PERIOD)):
            self._count += 1
            axes = [1.0 if axis in TRIGGERS else 0.0 for axis in range(AXES)]
            for axis, value in pushed.items():
                axes[axis] = value * (1.0 - TREMBLE * (self._count % 2))
            message = Joy(
                axes=axes, buttons=[int(b == DEADMAN and is_held) for b in range(BUTTONS)]
            )
            message.header.stamp = self._client.node.get_clock().now().to_msg()
            self._publisher.publish(message)
            self._client.spin(PERIOD)
