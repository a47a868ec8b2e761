"""The part of serial_bridge that receives STOP, in a thread of its own.

Where messages come faster than the node's executor takes them, they queue up ahead of a STOP, for
seconds; a callback of another node on the same executor holds it up as well. This executor has
nothing else to do.
"""

import os
import signal
import threading
from collections.abc import Callable

from rclpy.experimental import EventsExecutor
from rclpy.node import Node
from std_msgs.msg import Bool
from std_srvs.srv import Trigger

from manipulator.nodes.late_answers import Call, create_late_service
from manipulator.nodes.qos import EVERY_WORD


class StopNode(Node):
    """`emergency_stop` and `~/stop`, as a node beside its `owner`; spun from `start` to `close`.

    Where its thread dies of an error the process ends: it would seem alive, and obey no STOP.
    """

    def __init__(
        self, owner: Node, on_stop: Callable[[], None], on_call: Callable[[Call], None]
    ) -> None:
        """Both are called in this node's thread and must not wait."""
        super().__init__(f'{owner.get_name()}_stop', start_parameter_services=False)
        self._on_stop = on_stop
        self.create_subscription(Bool, 'emergency_stop', self._on_message, EVERY_WORD)
        create_late_service(self, Trigger, f'{owner.get_name()}/stop', on_call)
        self._own_executor = EventsExecutor()
        self._own_executor.add_node(self)
        self._is_closing = False
        self._thread = threading.Thread(target=self._spin, name='stop', daemon=True)

    def start(self) -> None:
        """From here on messages and calls are received."""
        self._thread.start()

    def close(self) -> None:
        """Ends the thread and leaves the graph."""
        self._is_closing = True
        self._own_executor.wake()
        self._thread.join()
        self._own_executor.shutdown()
        self.destroy_node()

    def _on_message(self, message: Bool) -> None:
        if message.data:
            self._on_stop()

    def _spin(self) -> None:
        try:
            while not self._is_closing:
                self._own_executor.spin_once(timeout_sec=0.1)
        finally:
            if not self._is_closing:
                os.kill(os.getpid(), signal.SIGTERM)
