"""The part of serial_bridge that hears STOP, in a thread of its own: it waits for no service."""

from collections.abc import Callable
from concurrent.futures import Future

from rclpy.node import Node
from std_msgs.msg import Bool
from std_srvs.srv import Trigger

from bridge.board_answers import BoardAnswers
from bridge.link_thread import LinkThread
from bridge.messages import Stop
from bridge.side_node import SideNode
from manipulator.nodes.qos import EVERY_WORD


class StopNode(SideNode):
    """`emergency_stop` and `~/stop`."""

    def __init__(
        self,
        owner: Node,
        link: LinkThread,
        answers: BoardAnswers,
        remember: Callable[[], None],
    ) -> None:
        """`remember` is called after each STOP that was asked for, also if no board heard it."""
        super().__init__(owner, 'stop')
        self._link, self._answers, self._remember = link, answers, remember
        self.create_subscription(Bool, 'emergency_stop', self._on_message, EVERY_WORD)
        self.create_service(Trigger, f'{owner.get_name()}/stop', self._on_service)

    def stop(self) -> None:
        """STOP to the board, now or as soon as there is one; from any thread."""
        asked = self._link.request(Stop())
        self._remember()
        asked.add_done_callback(self._say_failed)

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
        done = 'stopped: ~/clear_fault ends it'
        response.success, response.message = self._answers.ask(Stop(), done)
        self._remember()
        return response
