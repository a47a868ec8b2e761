"""One web page for one machine: shows the graph, sends the user's requests."""

import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Generic, TypeVar

import numpy as np
from diagnostic_msgs.msg import DiagnosticStatus
from rclpy.node import Node
from std_msgs.msg import Float64

from hexarm import saved_goals
from hexarm.link_meshes import meshes_of
from hexarm.panel import page_state
from hexarm.panel.gripper import gripper_of
from hexarm.panel.nodes.machine_subscriptions import MachineSubscriptions
from hexarm.panel.nodes.request_client import RequestClient
from hexarm.panel.nodes.web_server import (
    CONTROLS_PATH,
    JOYSTICK_PATH,
    ControlsSocket,
    JoystickSocket,
    address,
    start_server,
    stop_server,
)
from hexarm.panel.page_requests import Request
from hexarm.panel.page_state import Controls
from hexarm.panel.pieces import sphere
from hexarm.panel.reachable import reachable_ranges
from hexarm.panel.scene import Scene
from hexarm.panel.view import View
from manipulator.analysis.inside import surface
from manipulator.analysis.reach import explained
from manipulator.arrays import Array
from manipulator.errors import ManipulatorError
from manipulator.formatting import counted
from manipulator.machine import Machine
from manipulator.nodes.devices.jog_topics import NO_TWIST, JogTopics
from manipulator.nodes.diagnostics import Diagnostics, Report
from manipulator.nodes.parameters import declare
from manipulator.nodes.qos import COMMAND
from manipulator.nodes.steady_timer import SteadyTimer
from manipulator.pose import Pose
from manipulator.saved_poses import SavedPose
from manipulator.states import MachineState, MotionMode
from manipulator.teleop.modes import MODES

Question = TypeVar('Question')


class NewestWorker(Generic[Question]):
    """Calls `work` with the newest question; those that were overtaken are never looked at."""

    def __init__(self, work: Callable[[Question], None]) -> None:
        self._work = work
        self._question: Question | None = None
        self._is_asked = threading.Event()
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def request(self, question: Question) -> None:
        """Returns at once."""
        self._question = question
        self._is_asked.set()

    def _run(self) -> None:
        while True:
            self._is_asked.wait()
            self._is_asked.clear()
            question, self._question = self._question, None
            if question is not None:
                begin = time.monotonic()
                self._work(question)
                time.sleep(time.monotonic() - begin)  # leaves half of the time to the rest


TICK = 0.02
DRAW_EVERY, STATE_EVERY, GOAL_EVERY, REDRAW_EVERY = 3, 5, 5, 20
"""Ticks between scene updates, states of the page, goals of the sliders, and all the rest."""

HAND_RESTS = 2.0
"""Seconds after the last move of a slider in which the sliders stay where the hand left them."""

FOLLOWED = (MotionMode.HOLD, MotionMode.JOG, MotionMode.CYCLE, MotionMode.PATH)
"""Modes in which the machine moves without the sliders."""

ELSEWHERE = 1e-4
REACH_GRID = (13, 24)
JOYSTICK_SHARE = 0.4
"""Part of the machine's speeds at full deflection, until a hand sets another."""
HOST = 'address to serve the page on; 0.0.0.0 for every network: there is no login'
PORT = 'port number of the page; where it is taken, the next free one'


class PanelNode(Node):
    """Everything of a machine on http://host:port; see docs/panel.md."""

    def __init__(self, load: Callable[[str], Machine], default_machine: str) -> None:
        super().__init__('panel')
        name = declare(self, 'machine', default_machine, 'machine file: a shipped name or a path')
        host = declare(self, 'host', '127.0.0.1', HOST)
        port = declare(self, 'port', 8080, PORT, (1, 65535))
        self._machine = load(name)
        gripper = gripper_of(name)
        self._joystick = JoystickSocket(self._why_still)
        self._received = MachineSubscriptions(self, self._machine, gripper)
        self._topics = JogTopics(self, 'panel')
        self._requests = RequestClient(self, self._joystick.stop)
        limits = self._machine.motion
        self._full = np.repeat([limits.linear.speed, limits.angular.speed], 3)
        self._share = JOYSTICK_SHARE
        label = f'{Path(name).stem} · {self.get_namespace()}'
        machine_text = page_state.machine_text(self._machine, label, gripper is not None)
        self._socket = ControlsSocket(machine_text, self._requests.take)
        handlers = {JOYSTICK_PATH: self._joystick.serve, CONTROLS_PATH: self._socket.serve}
        self._server = start_server(host, port, label, handlers)
        meshes, faults = meshes_of(name)
        for fault in faults:
            self.get_logger().warning(fault)
        self._scene = Scene(self._server, self._machine, gripper is not None, meshes)
        self._reach = NewestWorker[tuple[Pose, Array | None]](self._show_reach)
        self._moved_at = self._gripped_at = float('-inf')
        self._ticks = 0
        self._reach_at = self._machine.kinematics.home
        self._controls = Controls.at(self._reach_at)
        self._is_reach_asked = self._is_hull_drawn = False
        self._view = View()
        self.create_subscription(Float64, 'speed_override', self._on_speed, COMMAND)
        self._timer = SteadyTimer(self, TICK, self._tick)
        self._diagnostics = Diagnostics(self, self._report, ('cmd_vel/panel',))
        self.address = address(host, self._server.get_port())
        self.get_logger().info(f'the page is on {self.address}')

    def close(self) -> None:
        """Releases the machine, then closes the pages."""
        self._topics.close()
        stop_server(self._server)

    def _tick(self) -> None:
        for request in self._requests.new():
            try:
                self._take(request)
            except ManipulatorError as error:
                self._requests.notice = str(error)
        stick = self._joystick.stick()
        twist = NO_TWIST if stick is None else stick * self._full * self._share
        self._topics.drive(twist, '', stick is not None)
        self._ticks += 1
        if self._is_time_for(GOAL_EVERY):
            self._requests.send_goal()
        is_watched = bool(self._server.get_clients()) or self._socket.pages > 0
        self._received.watch(is_watched)
        if is_watched:
            self._draw()

    def _take(self, request: Request) -> None:
        """What hands on the page ask of the page itself."""
        if request.do == 'goal':
            self._request_goal(self._controls.move(request.axis, request.value))
        elif request.do == 'go_to' and request.name in self._view.saved:
            self._go_to(self._view.saved[request.name])
        elif request.do == 'grip':
            self._gripped_at = time.monotonic()
            self._topics.open_to(min(max(request.value, 0.0), 1.0))
        elif request.do == 'mode' and request.name in MODES:
            self._topics.choose(request.name)
        elif request.do == 'share':
            self._share = min(max(request.value, 0.01), 1.0)
        elif request.do == 'tool':
            self._machine.frames.with_tool(request.name)  # raises what trajectory logs
        elif request.do == 'show_reach':
            self._scene.set_reach_visible(request.value > 0)
        elif request.do == 'clear_trail':
            self._scene.clear_trail()

    def _draw(self) -> None:
        if self._is_time_for(DRAW_EVERY):
            self._view = self._received.view()
            self._scene.show(self._view)
        if self._is_time_for(STATE_EVERY):
            texts = self._socket.texts
            notice = self._requests.notice
            texts['state'] = page_state.state_text(self._view, self._controls, notice)
        if self._is_time_for(REDRAW_EVERY):
            self._socket.texts['nodes'] = page_state.nodes_text(self._view.nodes)
            self._scene.draw_trail()
            self._follow(self._view)

    def _follow(self, view: View) -> None:
        """Sliders show where the machine is, unless a hand has just moved one."""
        if not self._is_reach_asked:
            self._is_reach_asked = True
            self._ask_reach(self._controls.pose)
        now = time.monotonic()
        if now - self._gripped_at > HAND_RESTS and view.measured is not None:
            self._controls.opening = view.measured.opening
        if view.commanded is None or now - self._moved_at < HAND_RESTS:
            return
        pose = view.commanded.pose
        if view.mode in FOLLOWED and self._is_elsewhere(pose):
            self._controls.follow(pose)
            self._scene.show_goal(pose)
        if (
            view.mode == MotionMode.HOLD
            and np.abs(self._reach_at.twist_to(pose)).max() > ELSEWHERE
        ):
            self._ask_reach(pose)

    def _is_elsewhere(self, pose: Pose) -> bool:
        return bool(np.abs(self._controls.pose.twist_to(pose)).max() > ELSEWHERE)

    def _request_goal(self, pose: Pose) -> None:
        self._moved_at = time.monotonic()
        self._requests.request_goal(pose)
        self._ask_reach(pose)

    def _go_to(self, saved: SavedPose) -> None:
        joints = saved_goals.joints_of(self._machine, saved)
        self._controls.follow(saved.pose)
        if joints is None:
            self._request_goal(saved.pose)
            return
        self._moved_at = time.monotonic()
        self._requests.send_joints(joints)
        self._ask_reach(saved.pose)

    def _ask_reach(self, pose: Pose) -> None:
        self._scene.show_goal(pose)
        self._reach_at = pose
        commanded = self._view.commanded
        self._reach.request((pose, None if commanded is None else commanded.joints))

    def _show_reach(self, question: tuple[Pose, Array | None]) -> None:
        """In the worker's thread: the range of each slider, and once the hull."""
        pose, near = question
        ranges = reachable_ranges(self._machine, pose, near)
        reason = '' if ranges.any() else explained(self._machine, pose, near)
        self._controls.show_reach(pose, ranges, reason)
        if not self._is_hull_drawn:
            self._is_hull_drawn = True
            self._scene.show_reach(surface(self._machine, sphere(*REACH_GRID)))

    def _why_still(self) -> str:
        """What a hand on the joystick should know."""
        state = self._received.machine_state.message
        return '' if state == MachineState.ENABLED else f'the machine is {state}'

    def _on_speed(self, message: Float64) -> None:
        if 0.0 <= message.data <= 1.0:
            self._controls.speed = message.data

    def _is_time_for(self, every: int) -> bool:
        return self._ticks % every == 0

    def _report(self) -> Report:
        pages = self._socket.pages
        holds = self._joystick.stick() is not None
        values = {'address': self.address, 'pages': pages, 'joystick_held': holds}
        return DiagnosticStatus.OK, counted(pages, 'page'), values
