"""The panel's requests to the graph: goals, services, the emergency stop, the speed override."""

import queue
import time
from collections.abc import Callable
from typing import Any

from geometry_msgs.msg import PoseStamped
from rclpy.node import Node
from rclpy.task import Future
from std_msgs.msg import Bool, Float64
from std_srvs.srv import SetBool, Trigger

from hexarm.panel.controls import Requests
from manipulator.nodes.messages import pose_message
from manipulator.nodes.qos import COMMAND, EVERY_WORD
from manipulator.pose import Pose

TRIGGERS = (
    'serial_bridge/stop',
    'serial_bridge/clear_fault',
    'trajectory/home',
    'trajectory/stop',
    'trajectory/start_cycle',
)
ANSWERED_WITHIN = 4.0
SWITCHES = ('serial_bridge/enable', 'trajectory/pause')


class RequestClient:
    """Requests come from the web server's threads and are put to the graph in the node's own.

    Only the emergency stop does not wait for it: its message goes out at once.
    """

    def __init__(
        self,
        node: Node,
        on_stop: Callable[[], None],
        choose_mode: Callable[[str], None],
        grip: Callable[[float], None],
    ) -> None:
        self._node = node
        self._on_stop = on_stop
        self._choose_mode = choose_mode
        self._grip = grip
        self._pending: queue.SimpleQueue[Callable[[], None]] = queue.SimpleQueue()
        self._goal: Pose | None = None
        self._waiting: dict[Future, tuple[str, float]] = {}
        self.notice = ''
        self._goals = node.create_publisher(PoseStamped, 'goal_pose', COMMAND)
        self._stops = node.create_publisher(Bool, 'emergency_stop', EVERY_WORD)
        self._speeds = node.create_publisher(Float64, 'speed_override', COMMAND)
        self._clients = {name: node.create_client(Trigger, name) for name in TRIGGERS}
        self._clients |= {name: node.create_client(SetBool, name) for name in SWITCHES}

    @property
    def requests(self) -> Requests:
        """For the page's buttons; safe from any thread."""
        return Requests(
            emergency_stop=self._emergency_stop,
            clear_fault=self._later('serial_bridge/clear_fault'),
            enable=lambda on: self._pending.put(lambda: self._switch('serial_bridge/enable', on)),
            home=self._later('trajectory/home'),
            start_cycle=self._later('trajectory/start_cycle'),
            pause=lambda on: self._pending.put(lambda: self._switch('trajectory/pause', on)),
            brake=self._later('trajectory/stop'),
            set_speed=lambda share: self._pending.put(
                lambda: self._speeds.publish(Float64(data=share))
            ),
            choose_mode=lambda mode: self._pending.put(lambda: self._choose_mode(mode)),
            grip=lambda opening: self._pending.put(lambda: self._grip(opening)),
        )

    def request_goal(self, pose: Pose) -> None:
        """The newest goal replaces one that is not yet sent."""
        self._goal = pose

    def put(self) -> None:
        """Sends all requests since the last call to the graph."""
        while True:
            try:
                self._pending.get_nowait()()
            except queue.Empty:
                break
        self._give_up()

    def send_goal(self) -> bool:
        """The newest goal, if there is one; whether it was sent."""
        goal, self._goal = self._goal, None
        if goal is not None:
            self._goals.publish(pose_message(goal, self._node.get_clock().now().to_msg()))
        return goal is not None

    def _emergency_stop(self) -> None:
        self._stops.publish(Bool(data=True))
        self._goal = None
        self._on_stop()
        self._pending.put(lambda: self._call('serial_bridge/stop', Trigger.Request()))

    def _later(self, name: str) -> Callable[[], None]:
        return lambda: self._pending.put(lambda: self._call(name, Trigger.Request()))

    def _switch(self, name: str, is_on: bool) -> None:
        self._call(name, SetBool.Request(data=is_on))

    def _call(self, name: str, request: Any) -> None:
        client = self._clients[name]
        if not client.service_is_ready():
            self.notice = f'{name}: the service is not available'
            return
        future = client.call_async(request)
        self._waiting[future] = name, time.monotonic() + ANSWERED_WITHIN
        future.add_done_callback(self._on_answer)

    def _on_answer(self, future: Future) -> None:
        name, _ = self._waiting.pop(future)
        answer = future.result()
        self.notice = '' if answer.success else f'{name}: {answer.message}'

    def _give_up(self) -> None:
        """Notes services that do not answer: a node that was killed seems ready for 20 s."""
        now = time.monotonic()
        for future, (name, until) in list(self._waiting.items()):
            if now > until:
                del self._waiting[future]
                self._clients[name].remove_pending_request(future)
                self.notice = f'{name}: no answer within {ANSWERED_WITHIN:g} s, does its node run?'
