"""The panel's requests to the graph: goals, services, the emergency stop, the speed override."""

import queue
import time
from collections.abc import Callable, Mapping
from typing import Any

from geometry_msgs.msg import PoseStamped
from rclpy.node import Node
from rclpy.task import Future
from sensor_msgs.msg import JointState
from std_msgs.msg import Bool, Float64, String
from std_srvs.srv import SetBool, Trigger

from hexarm.panel.page_requests import Request
from manipulator.nodes.messages import pose_message
from manipulator.nodes.qos import COMMAND, EVERY_WORD, LATCHED
from manipulator.pose import Pose

STOP = 'stop'
SERVICES: dict[str, tuple[str, str, bool | None]] = {
    STOP: ('STOP', 'serial_bridge/stop', None),
    'enable': ('Enable', 'serial_bridge/enable', True),
    'disable': ('Disable', 'serial_bridge/enable', False),
    'clear': ('Clear fault', 'serial_bridge/clear_fault', None),
    'home': ('Home', 'trajectory/home', None),
    'park': ('Park', 'trajectory/park', None),
    'cycle': ('Cycle', 'trajectory/start_cycle', None),
    'brake': ('Brake', 'trajectory/stop', None),
    'pause': ('Pause', 'trajectory/pause', True),
    'resume': ('Go on', 'trajectory/pause', False),
}
"""By request: its button, the service, and the value of one that switches."""
ANSWERED_WITHIN = 4.0
NOBODY = 'nothing answers, does hexarm up run?'


class RequestClient:
    """Requests come from the web server's thread and are put to the graph in the node's own.

    Only the emergency stop does not wait for it: its message goes out at once.
    """

    def __init__(self, node: Node, on_stop: Callable[[], None]) -> None:
        self._node, self._on_stop = node, on_stop
        self._pending: queue.SimpleQueue[Request] = queue.SimpleQueue()
        self._goal: Pose | None = None
        self._waiting: dict[Future, tuple[str, Any, float]] = {}
        self.notice = ''
        publish = node.create_publisher
        self._goals = publish(PoseStamped, 'goal_pose', COMMAND)
        self._joints = publish(JointState, 'goal_joints', COMMAND)
        self._stops = publish(Bool, 'emergency_stop', EVERY_WORD)
        self._speeds = publish(Float64, 'speed_override', COMMAND)
        self._names = {
            'save': publish(String, 'save_pose', EVERY_WORD),
            'delete': publish(String, 'delete_pose', EVERY_WORD),
            'tool': publish(String, 'tool', COMMAND),
        }
        node.create_subscription(String, 'saved_pose_status', self._on_saved, LATCHED)
        kinds = {
            name: Trigger if is_on is None else SetBool for _, name, is_on in SERVICES.values()
        }
        self._clients = {name: node.create_client(kind, name) for name, kind in kinds.items()}

    def take(self, request: Request) -> None:
        """Takes a request, from any thread; returns at once."""
        if request.do == STOP:
            self._stops.publish(Bool(data=True))
            self._goal = None
            self._on_stop()
        self._pending.put(request)

    def new(self) -> list[Request]:
        """The requests since the last call; those to the graph alone are sent."""
        found = []
        while True:
            try:
                request = self._pending.get_nowait()
            except queue.Empty:
                break
            found.append(request)
            self._put(request)
        self._give_up()
        return found

    def _put(self, request: Request) -> None:
        if request.do in SERVICES:
            self._call(*SERVICES[request.do])
        elif request.do in self._names:
            self._names[request.do].publish(String(data=request.name))
        elif request.do == 'speed':
            self._speeds.publish(Float64(data=min(max(request.value, 0.0), 1.0)))
        elif request.do == 'joint':
            self.send_joints({request.name: request.value})

    def send_joints(self, named: Mapping[str, float]) -> None:
        """A goal of joints (rad, m) by name; it replaces a goal that is not yet sent."""
        self._goal = None
        message = JointState(name=list(named), position=list(named.values()))
        message.header.stamp = self._node.get_clock().now().to_msg()
        self._joints.publish(message)

    def request_goal(self, pose: Pose) -> None:
        """The newest goal replaces one that is not yet sent."""
        self._goal = pose

    def send_goal(self) -> None:
        """The newest goal, if there is one."""
        goal, self._goal = self._goal, None
        if goal is not None:
            self._goals.publish(pose_message(goal, self._node.get_clock().now().to_msg()))

    def _call(self, button: str, service: str, is_on: bool | None) -> None:
        client = self._clients[service]
        if not client.service_is_ready():
            self.notice = f'{button}: {NOBODY}'
            return
        request = Trigger.Request() if is_on is None else SetBool.Request(data=is_on)
        future = client.call_async(request)
        self._waiting[future] = button, client, time.monotonic() + ANSWERED_WITHIN
        future.add_done_callback(self._on_answer)

    def _on_answer(self, future: Future) -> None:
        button, *_ = self._waiting.pop(future)
        answer = future.result()
        is_news = not answer.success or button == 'Pause'
        self.notice = f'{button}: {answer.message}' if is_news else ''

    def _on_saved(self, message: String) -> None:
        if message.data:
            self.notice = f'saved poses: {message.data}'

    def _give_up(self) -> None:
        """Notes services that do not answer: a node that was killed seems ready for 20 s."""
        now = time.monotonic()
        for future, (button, client, until) in list(self._waiting.items()):
            if now > until:
                del self._waiting[future]
                client.remove_pending_request(future)
                self.notice = (
                    f'{button}: no answer within {ANSWERED_WITHIN:g} s, does hexarm up run?'
                )
