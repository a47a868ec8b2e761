"""The part of serial_bridge that gives the board programs to play by itself."""

import time
from collections.abc import Callable, Sequence

import numpy as np
from rclpy.node import Node
from std_msgs.msg import String
from std_srvs.srv import SetBool, Trigger
from trajectory_msgs.msg import JointTrajectory

from bridge.calibration import Calibration
from bridge.link import Link
from bridge.programs import Upload, count_table
from bridge.protocol import Command, CycleAxis, Finish, Play, Program
from manipulator.arrays import Array
from manipulator.errors import InvalidInput, ManipulatorError
from manipulator.nodes.late_answers import Call, create_late_service
from manipulator.nodes.parameters import declare
from manipulator.nodes.qos import COMMAND, LATCHED
from manipulator.nodes.subscriptions import decoded

AXES = 'x, y, z, roll, pitch, yaw'
ANSWER_WITHIN = 5.0
MOST_BYTES = 100_000
"""Of a joint_table: twice what a board holds, and decoded in 6 ms."""
BUSY = 'another upload is in progress'


class ProgramTopics:
    """`joint_table`, `program_status`, `~/play_table`, `~/play_cycle` and `~/finish_program`.

    On a bad line the board takes seconds to answer: uploads go on in the link's thread.
    """

    def __init__(
        self,
        node: Node,
        calibration: Calibration,
        link: Link,
        post: Callable[[Callable[[], object]], None],
    ) -> None:
        """`post` has something done in the link's thread."""
        self._node, self._calibration, self._link, self._post = node, calibration, link, post
        self._is_busy = False
        for name, unit in (('amplitude', 'm, rad'), ('frequency', 'Hz'), ('phase', 'rad')):
            description = f"of the board's cycle ({unit}) about {AXES}"
            declare(node, f'board_cycle.{name}', [0.0] * 6, description, is_read_only=False)
        self._status = node.create_publisher(String, 'program_status', LATCHED)
        node.create_subscription(JointTrajectory, 'joint_table', self._on_table, COMMAND, raw=True)
        create_late_service(node, SetBool, '~/play_table', self._on_play_table)
        create_late_service(node, SetBool, '~/play_cycle', self._on_play_cycle)
        create_late_service(node, Trigger, '~/finish_program', self._on_finish)

    # In the executor's thread

    def _on_table(self, serialized: bytes) -> None:
        try:
            message = decoded(serialized, JointTrajectory, MOST_BYTES)
            table = count_table(*_columns(message, self._calibration.names), self._calibration)
        except ManipulatorError as error:
            self._publish(f'joint_table refused: {error}')
            return
        rows = len(table.rows)
        done = f'table of {rows} rows, {table.step_ms} ms apart, is on board'
        self._post(lambda: self._upload(table.upload, done))

    def _on_play_table(self, call: Call) -> None:
        commands = (Play(Program.TABLE, call.request.data),)
        self._post(lambda: self._play(call, commands, 'the board plays its table'))

    def _on_play_cycle(self, call: Call) -> None:
        try:
            commands: list[Command] = [*self._axes(), Play(Program.CYCLE, call.request.data)]
        except InvalidInput as error:
            _answer(call, str(error), '')
            return
        self._post(lambda: self._play(call, commands, 'the board checks its cycle, then plays it'))

    def _on_finish(self, call: Call) -> None:
        done = 'the board ends its program smoothly'
        self._post(lambda: self._begin((Finish(),), lambda reason: _answer(call, reason, done)))

    def _axes(self) -> tuple[CycleAxis, ...]:
        """The six axes from the parameters; InvalidInput where they are not six numbers each."""
        columns = []
        for name in ('amplitude', 'frequency', 'phase'):
            values = list(self._node.get_parameter(f'board_cycle.{name}').value)
            if len(values) != 6 or not np.isfinite(values).all():
                raise InvalidInput(f'parameter board_cycle.{name}: {values}, needs six numbers')
            columns.append(values)
        rows = enumerate(zip(*columns, strict=True))
        return tuple(CycleAxis(k, a, _millihertz(f), p) for k, (a, f, p) in rows)

    # In the link's thread

    def _upload(self, commands: Sequence[Command], done: str) -> None:
        if self._is_busy:
            self._publish(f'joint_table refused: {BUSY}')
            return

        def end(reason: str) -> None:
            self._is_busy = False
            self._publish(f'upload failed: {reason}' if reason else done)

        self._is_busy = True
        Upload(self._link.request, commands, end).begin()

    def _play(self, call: Call, commands: Sequence[Command], done: str) -> None:
        """Answers when the board has obeyed them all; refused where it would spoil an upload."""
        if self._is_busy:
            _answer(call, BUSY, '')
            return

        def end(reason: str) -> None:
            self._is_busy = False
            _answer(call, reason, done)

        self._is_busy = True
        self._begin(commands, end)

    def _begin(self, commands: Sequence[Command], end: Callable[[str], None]) -> None:
        """Sends them one by one; where that takes too long, no further one."""
        until = time.monotonic() + ANSWER_WITHIN

        def late() -> str:
            is_late = time.monotonic() > until
            return f'not all obeyed within {ANSWER_WITHIN:g} s, given up' if is_late else ''

        Upload(self._link.request, commands, end, late).begin()

    # In either

    def _publish(self, text: str) -> None:
        self._node.get_logger().info(text)
        self._status.publish(String(data=text))


def _answer(call: Call, reason: str, done: str) -> None:
    """`reason` is why it was not obeyed, '' where it was."""
    call.response.success, call.response.message = not reason, reason or done
    call.send()


def _columns(message: JointTrajectory, names: Sequence[str]) -> tuple[Array, Array]:
    """Times (n,) and positions (n, joints) in the order of `names`; InvalidInput otherwise."""
    if sorted(message.joint_names) != sorted(names):
        given, needed = (', '.join(some) for some in (message.joint_names, names))
        raise InvalidInput(f'joints are {given or "none"}, needs {needed}')
    order = [list(message.joint_names).index(name) for name in names]
    if any(len(point.positions) != len(names) for point in message.points):
        raise InvalidInput(f'a point has no {len(names)} positions')
    spans = (point.time_from_start for point in message.points)
    times = np.array([span.sec + 1e-9 * span.nanosec for span in spans])
    positions = np.array([point.positions for point in message.points], dtype=np.float64)
    return times, positions.reshape(-1, len(names))[:, order]


def _millihertz(frequency: float) -> int:
    if not 0 <= frequency <= 25:
        raise InvalidInput(f'board_cycle.frequency: {frequency:g} Hz outside [0, 25] Hz')
    return round(1000 * frequency)
