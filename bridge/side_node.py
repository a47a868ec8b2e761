"""A node of this process, in a thread of its own, whose callbacks wait for nobody else's."""

import os
import signal
import threading

from rclpy.experimental import EventsExecutor
from rclpy.node import Node


class SideNode(Node):
    """Named after its `owner`, `serial_bridge_stop`; spun from `start` to `close`.

    Where its thread dies of an error, the whole process ends: it would be deaf and look alive.
    """

    def __init__(self, owner: Node, purpose: str) -> None:
        super().__init__(f'{owner.get_name()}_{purpose}', start_parameter_services=False)
        self._executor_aside = EventsExecutor()
        self._executor_aside.add_node(self)
        self._is_closing = False
        self._thread = threading.Thread(target=self._spin, name=purpose, daemon=True)

    def start(self) -> None:
        """From here on messages and calls are heard."""
        self._thread.start()

    def close(self) -> None:
        """Ends the thread and leaves the graph; waits for a callback that is under way."""
        self._is_closing = True
        self._executor_aside.wake()
        self._thread.join()
        self._executor_aside.shutdown()
        self.destroy_node()

    def _spin(self) -> None:
        try:
            while not self._is_closing:
                self._executor_aside.spin_once(timeout_sec=0.1)
        finally:
            if not self._is_closing:
                os.kill(os.getpid(), signal.SIGTERM)
