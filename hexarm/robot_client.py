"""What `Robot` does in the graph: motions that are braked unless they end, jogs, measurements."""

import time
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from functools import partial
from typing import Any

from geometry_msgs.msg import PoseStamped, TwistStamped
from rcl_interfaces.msg import Parameter, ParameterType, ParameterValue
from rcl_interfaces.srv import GetParameters, SetParameters
from sensor_msgs.msg import JointState
from std_msgs.msg import Bool, String
from std_srvs.srv import Trigger

from hexarm.client import Client
from hexarm.robot_values import share_done
from manipulator.errors import ManipulatorError, Refused, Stopped, TimedOut
from manipulator.nodes.messages import pose_of
from manipulator.nodes.messages import seconds as seconds_of
from manipulator.nodes.qos import COMMAND, EVERY_WORD, LATCHED
from manipulator.pose import Pose
from manipulator.states import MachineState, MotionMode

Progress = Callable[[float], object]
"""Receives the share of a motion that is done, 0 to 1, while it is waited for."""

AT_REST = ('', MotionMode.DISABLED, MotionMode.HOLD)
PATIENCE = 10.0
"""Seconds without any motion or message after which a wait is given up."""
JOG_PERIOD = 0.02
ACCEPTED_WITHIN = 0.5
"""Seconds until a jog command that is accepted shows in the motion mode."""


class RobotClient(Client):
    """A client with at most one motion under way."""

    def __init__(self, namespace: str, interrupt: Callable[[], None]) -> None:
        super().__init__(namespace, interrupt)
        self.is_under_way = False
        self._progress: Progress | None = None
        self._start: Pose | None = None
        self._goal: Pose | None = None
        self._share = -1.0
        self._newest: dict[str, Any] = {}
        self._received = Counter[str]()
        for name, kind in (('pose', PoseStamped), ('joint_states', JointState)):
            self.node.create_subscription(kind, name, partial(self._note, name), COMMAND)
        self.watch_setpoints()
        self._publishers: dict[str, Any] = {}
        self._stops = self.node.create_publisher(Bool, 'emergency_stop', EVERY_WORD)
        self._brakes = self.node.create_client(Trigger, 'trajectory/stop')
        for name in ('saved_poses', 'saved_pose_status'):
            self.node.create_subscription(String, name, partial(self._note, name), LATCHED)

    def receive(self) -> None:
        """Takes up what has been received by now."""
        self.spin(0.01)

    def fresh(self, name: str) -> Any:
        """A message sent after this call: of those before it one at most waits to be read."""
        before = self._received[name]
        self.wait(f'{name}: is it enabled?', lambda: self._received[name] > before + 1, 5.0)
        return self._newest[name]

    def commanded(self) -> Pose:
        """The pose that the machine is commanded to; Refused where it does not take goals."""
        self.receive()
        if self.machine_state.message != MachineState.ENABLED:
            space = self.node.get_namespace()
            raise Refused(f'{space} takes no goals: {self.summary}')
        return pose_of(self.fresh('setpoint'))

    def destination(self) -> Pose:
        """The end of the motion under way, else the commanded pose."""
        with suppress(Refused, Stopped):
            self.poll()
        if self.is_under_way and self._goal is not None:
            return self._goal
        return self.commanded()

    # Motions

    def begin(
        self,
        send: Callable[[], object],
        goal: Pose | None = None,
        progress: Progress | None = None,
    ) -> None:
        """Sends a command that moves; `goal` is its last pose, where that is known."""
        message = self._newest.get('setpoint')
        self._start = None if message is None else pose_of(message)
        self._goal, self._progress, self._share = goal, progress, -1.0
        with self._braking():
            self.is_under_way = True
            send()

    def begin_path(self, poses: Pose, speed: float | None, progress: Progress | None) -> None:
        """As `begin`, along poses (n,) at `speed` (m/s) at most, None: trajectory's path_speed."""
        self.begin(lambda: self._send_path_at(poses, speed), poses[-1], progress)

    def finish(self, timeout: float) -> None:
        """Waits for the end of the motion; Refused, Stopped or TimedOut with the reason."""
        if not self.is_under_way:
            return
        with self._braking():
            self.await_goal(timeout, self._report)
            self._tell(1.0)
            self.is_under_way = False

    def poll(self) -> None:
        """Takes up what has been received of the motion; raises as `finish`."""
        if not self.is_under_way:
            return
        with self._braking():
            self.receive()
            if self.is_there():
                self._tell(1.0)
                self.is_under_way = False
            else:
                self._report()

    @contextmanager
    def _braking(self) -> Iterator[None]:
        """Brakes a motion that is left otherwise than by its end: by Ctrl-C, a timeout."""
        try:
            yield
        except (Refused, Stopped):
            self.is_under_way = False
            raise
        except BaseException:
            self.brake()
            raise

    def brake(self) -> None:
        """Brakes; the request is out before anything is waited for."""
        self.is_under_way = False
        future = self._brakes.call_async(Trigger.Request())
        with suppress(ManipulatorError):
            self.wait('braking', future.done, 1.0)

    def rest(self) -> None:
        """Brakes, and waits until the machine holds."""
        self.is_under_way = False
        self.trigger('trajectory/stop')
        self.wait('rest', self.is_at_rest, PATIENCE)

    def is_at_rest(self) -> bool:
        """Whether the machine holds, or is not driven."""
        return self.motion('mode') in AT_REST

    def _send_path_at(self, poses: Pose, speed: float | None) -> None:
        self._start = None
        if speed is None:
            self.send_path(poses)
            return
        usual = self._path_speed()
        self._set_path_speed(speed)
        try:
            self.send_path(poses)
            self.wait('the path', self.is_known, PATIENCE)
        finally:
            self._set_path_speed(usual)

    def _path_speed(self) -> float:
        request = GetParameters.Request(names=['path_speed'])
        (value,) = self.ask(GetParameters, 'trajectory/get_parameters', request).values
        return float(value.double_value)

    def _set_path_speed(self, speed: float) -> None:
        value = ParameterValue(type=ParameterType.PARAMETER_DOUBLE, double_value=speed)
        request = SetParameters.Request(parameters=[Parameter(name='path_speed', value=value)])
        (result,) = self.ask(SetParameters, 'trajectory/set_parameters', request).results
        if not result.successful:
            raise Refused(f'speed {speed:g} m/s: {result.reason}')

    def _report(self) -> None:
        if self._progress is None or not self.is_known():
            return
        percent, here = self.motion('percent'), self._newest.get('setpoint')
        if percent:
            self._tell(int(percent) / 100)
        elif here is not None and self._start is not None and self._goal is not None:
            self._tell(share_done(self._start, pose_of(here), self._goal))

    def _tell(self, share: float) -> None:
        """Passes on a share that is larger than the last."""
        if self._progress is not None and share > self._share:
            self._share = share
            self._progress(share)

    def send_joints(self, named: Mapping[str, float]) -> None:
        """As `send_goal`, to positions of joints by name (rad, m)."""
        publisher = self._received_on(JointState, 'goal_joints')
        message = JointState(name=list(named), position=list(named.values()))
        message.header.stamp = self.node.get_clock().now().to_msg()
        publisher.publish(message)
        self._pursue(f'{seconds_of(message.header.stamp):.9f}')

    def _received_on(self, kind: type, topic: str) -> Any:
        """The publisher of a topic, once the machine receives it."""
        if topic not in self._publishers:
            self._publishers[topic] = self.node.create_publisher(kind, topic, COMMAND)
        publisher = self._publishers[topic]
        self.wait(f'a subscriber on {topic}', lambda: self.reaches(publisher), PATIENCE)
        return publisher

    # Jogging and stopping

    def jog(self, twist: Sequence[float], frame: str, seconds: float) -> None:
        """Publishes a twist for a while, then a zero, and waits until the machine holds."""
        twists = self._received_on(TwistStamped, 'cmd_vel')

        def send(share: float) -> None:
            message = TwistStamped()
            message.header.frame_id = frame
            message.header.stamp = self.node.get_clock().now().to_msg()
            linear, angular = message.twist.linear, message.twist.angular
            numbers = [share * value for value in twist]
            linear.x, linear.y, linear.z, angular.x, angular.y, angular.z = numbers
            twists.publish(message)

        self._jog(send, seconds)

    def jog_joints(self, rates: Mapping[str, float], seconds: float) -> None:
        """As `jog`, rates of joints by name (rad/s, m/s)."""
        publisher = self._received_on(JointState, 'cmd_joints')

        def send(share: float) -> None:
            velocities = [share * rate for rate in rates.values()]
            message = JointState(name=list(rates), velocity=velocities)
            message.header.stamp = self.node.get_clock().now().to_msg()
            publisher.publish(message)

        self._jog(send, seconds)

    def _jog(self, send: Callable[[float], None], seconds: float) -> None:
        """Sends a jog command for a while, then none of it, and waits until the machine holds."""
        until, is_accepted = time.monotonic() + seconds, False
        try:
            while (left := until - time.monotonic()) > 0.0:
                send(1.0)
                self.spin(min(JOG_PERIOD, left))
                is_accepted = self._is_jogged(is_accepted)
        finally:
            send(0.0)
        try:
            self.wait('jogging', lambda: is_accepted or self._is_jogged(False), ACCEPTED_WITHIN)
        except TimedOut:
            raise Refused(self._jog_refusal()) from None
        self.wait('rest', self.is_at_rest, PATIENCE)

    def _is_jogged(self, was: bool) -> bool:
        """Whether the machine is jogged; Stopped where it was, and is not any more."""
        is_jogged = self.motion('mode') == MotionMode.JOG
        if was and not is_jogged:
            raise Stopped(self.summary)
        return is_jogged

    def _jog_refusal(self) -> str:
        self.diagnostics.clear()  # the next report names it
        values = {pair.key: pair.value for pair in self.report_of('trajectory').values}
        return values.get('last_twist_refusal') or f'the jog is not accepted ({self.summary})'

    def emergency_stop(self) -> None:
        """STOP to the board at once, and again as a service, which confirms it."""
        self.is_under_way = False
        self._stops.publish(Bool(data=True))
        self.trigger('serial_bridge/stop')

    # Tools

    def use_tool(self, name: str) -> None:
        """Sends the name of a tool, and waits until it is reported to be in force."""
        self._received_on(String, 'tool').publish(String(data=name))
        self.wait(f'tool {name!r} in force', lambda: self.tool() == name, PATIENCE)

    def tool(self) -> str:
        """The tool in force, as trajectory reports it."""
        values = {pair.key: pair.value for pair in self.report_of('trajectory').values}
        return str(values.get('tool', ''))

    def fresh_pivot(self) -> PoseStamped:
        """As `fresh`, of pivot_pose, which is published while there is a subscriber."""
        if 'pivot_pose' not in self._publishers:
            note = partial(self._note, 'pivot_pose')
            self._publishers['pivot_pose'] = self.node.create_subscription(
                PoseStamped, 'pivot_pose', note, COMMAND
            )
        return self.fresh('pivot_pose')

    # Saved poses

    def saved_poses(self) -> str:
        """The text of the file of saved poses."""
        self.wait('saved_poses', lambda: 'saved_poses' in self._newest, PATIENCE)
        self.receive()
        return str(self._newest['saved_poses'].data)

    def change_saved_pose(self, topic: str, name: str) -> str:
        """Sends a name on `save_pose` or `delete_pose`; Refused with the reason."""
        self.saved_poses()
        answer = 'saved_pose_status'
        self.wait(answer, lambda: answer in self._newest, PATIENCE)
        changes = self.node.create_publisher(String, topic, EVERY_WORD)
        try:
            self.wait(f'a subscriber on {topic}', changes.get_subscription_count, PATIENCE)
            before = self._received.copy()
            changes.publish(String(data=name))
            self.wait(
                f'an answer to {topic}',
                lambda: self._received[answer] > before[answer] and self._is_outcome_of(name),
                PATIENCE,
            )
        finally:
            self.node.destroy_publisher(changes)
        saved, _, outcome = str(self._newest[answer].data).partition(': ')
        if outcome.startswith('refused: '):
            raise Refused(outcome.removeprefix('refused: '))
        texts = 'saved_poses'
        self.wait(texts, lambda: self._received[texts] > before[texts], PATIENCE)
        return saved

    def _is_outcome_of(self, name: str) -> bool:
        """Whether the newest outcome is that of `name`; of a new one for ''."""
        named, colon, _ = str(self._newest['saved_pose_status'].data).partition(': ')
        return bool(colon) and name in ('', named)

    def _note(self, name: str, message: Any) -> None:
        self._newest[name] = message
        self._received[name] += 1

    def _on_setpoint(self, message: PoseStamped) -> None:
        super()._on_setpoint(message)
        self._note('setpoint', message)
