"""The part of serial_bridge that hears STOP, in a thread of its own: it waits for no service."""

from collections.abc import Callable
from concurrent.futures import Future, wait

from rclpy.node import Node
from std_msgs.msg import Bool
from std_srvs.srv import Trigger

from bridge.driver import ANSWER_WITHIN, Asked, BoardDriver
from bridge.side_node import SideNode
from manipulator.nodes.qos import EVERY_WORD


class StopNode(SideNode):
    """`emergency_stop` and `~/stop`."""

    def __init__(
        self,
        owner: Node,
        driver: BoardDriver,
        remember: Callable[[], None],
    ) -> None:
        """`remember` is called after each STOP that was asked for, also if no board heard it."""
        super().__init__(owner, 'stop')
        self._driver, self._remember = driver, remember
        self.create_subscription(Bool, 'emergency_stop', self._on_message, EVERY_WORD)
        self.create_service(Trigger, f'{owner.get_name()}/stop', self._on_service)

    def stop(self) -> None:
        """STOP to the board, now or as soon as there is one; from any thread."""
        asked = self._driver.stop()
        self._remember()
        asked.future.add_done_callback(self._say_failed)

    def _on_message(self, message: Bool) -> None:
        if message.data:
            self.stop()

    def _say_failed(self, done: 'Future[None]') -> None:
        error = done.exception()
        if error is not None:
            text = f'STOP not obeyed yet, it is said again: {error}'
            self.get_logger().error(text, throttle_duration_sec=1.0)

    def _on_service(
        self, request: Trigger.Request, response: Trigger.Response
    ) -> Trigger.Response:
        asked = self._driver.stop()
        self._remember()
        response.success, response.message = answer_of(self._driver, asked)
        return response


def answer_of(driver: BoardDriver, asked: Asked) -> tuple[bool, str]:
    """Waits for it: whether the board obeyed within a second, and what to say."""
    wait([asked.future], ANSWER_WITHIN)
    return driver.answer(asked)
