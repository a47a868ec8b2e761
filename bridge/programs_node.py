"""The part of serial_bridge that gives the board programs to play by itself.

In a thread of its own: on a bad line the board takes seconds to answer.
"""

import threading
import time
from collections.abc import Callable, Sequence
from concurrent.futures import Future

import numpy as np
from rclpy.node import Node
from std_msgs.msg import String
from std_srvs.srv import SetBool, Trigger
from trajectory_msgs.msg import JointTrajectory

from bridge.calibration import Calibration
from bridge.count_table import count_table
from bridge.messages import Command
from bridge.program_messages import CycleAxis, Finish, Play, Program
from bridge.side_node import SideNode
from bridge.upload import Upload
from manipulator.arrays import Array
from manipulator.errors import InvalidInput, ManipulatorError
from manipulator.nodes.bounded import decoded
from manipulator.nodes.parameters import declare
from manipulator.nodes.qos import COMMAND, LATCHED

AXES = 'x, y, z, roll, pitch, yaw'
ANSWER_WITHIN = 5.0
LAST_TRIES = 1.0
"""Seconds in which the command that is under way when the time is up succeeds or fails."""
MOST_BYTES = 1_000_000
"""Of a joint_table: many times what a board holds."""
BUSY = 'another upload is under way'


class BoardPrograms(SideNode):
    """`joint_table`, `program_status`, `~/play_table`, `~/play_cycle` and `~/finish_program`."""

    def __init__(
        self,
        owner: Node,
        calibration: Calibration,
        request: Callable[[Command], 'Future[None]'],
    ) -> None:
        super().__init__(owner, 'programs')
        self._owner, self._calibration, self._request = owner, calibration, request
        self._is_busy = threading.Lock()
        for name, unit in (('amplitude', 'm, rad'), ('frequency', 'Hz'), ('phase', 'rad')):
            description = f"of the board's cycle ({unit}) about {AXES}"
            declare(owner, f'board_cycle.{name}', [0.0] * 6, description, is_read_only=False)
        self._status = self.create_publisher(String, 'program_status', LATCHED)
        self.create_subscription(JointTrajectory, 'joint_table', self._on_table, COMMAND, raw=True)
        name = owner.get_name()
        self.create_service(SetBool, f'{name}/play_table', self._on_play_table)
        self.create_service(SetBool, f'{name}/play_cycle', self._on_play_cycle)
        self.create_service(Trigger, f'{name}/finish_program', self._on_finish)

    def _on_table(self, serialized: bytes) -> None:
        try:
            message = decoded(serialized, JointTrajectory, MOST_BYTES)
            table = count_table(*_columns(message, self._calibration.names), self._calibration)
        except ManipulatorError as error:
            self._say(f'joint_table refused: {error}')
            return
        rows = len(table.rows)
        self._upload(table.upload, f'table of {rows} rows, {table.step_ms} ms apart, is on board')

    def _upload(self, commands: Sequence[Command], done: str) -> None:
        if not self._is_busy.acquire(blocking=False):
            self._say(f'joint_table refused: {BUSY}')
            return

        def end(reason: str) -> None:
            self._is_busy.release()
            self._say(f'upload failed: {reason}' if reason else done)

        Upload(self._request, commands, end, self._ending).begin()

    def _on_play_table(
        self, request: SetBool.Request, response: SetBool.Response
    ) -> SetBool.Response:
        commands = (Play(Program.TABLE, request.data),)
        response.success, response.message = self._play(commands, 'the board plays its table')
        return response

    def _on_play_cycle(
        self, request: SetBool.Request, response: SetBool.Response
    ) -> SetBool.Response:
        try:
            commands: list[Command] = [*self._axes(), Play(Program.CYCLE, request.data)]
        except InvalidInput as error:
            response.success, response.message = False, str(error)
            return response
        done = 'the board checks its cycle, then plays it'
        response.success, response.message = self._play(commands, done)
        return response

    def _on_finish(self, request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        done = 'the board ends its program smoothly'
        response.success, response.message = self._ask((Finish(),), done)
        return response

    def _axes(self) -> tuple[CycleAxis, ...]:
        """The six axes from the parameters; InvalidInput where they are not six numbers each."""
        columns = []
        for name in ('amplitude', 'frequency', 'phase'):
            values = list(self._owner.get_parameter(f'board_cycle.{name}').value)
            if len(values) != 6 or not np.isfinite(values).all():
                raise InvalidInput(f'parameter board_cycle.{name}: {values}, needs six numbers')
            columns.append(values)
        rows = enumerate(zip(*columns, strict=True))
        return tuple(CycleAxis(k, a, _millihertz(f), p) for k, (a, f, p) in rows)

    def _play(self, commands: Sequence[Command], done: str) -> tuple[bool, str]:
        """As `_ask`, unless an upload is under way, which it would spoil."""
        if not self._is_busy.acquire(blocking=False):
            return False, BUSY
        try:
            return self._ask(commands, done)
        finally:
            self._is_busy.release()

    def _ask(self, commands: Sequence[Command], done: str) -> tuple[bool, str]:
        """Whether the board obeyed them all, and what to say; after that nothing more is sent."""
        ended = threading.Event()
        reasons = []
        until = time.monotonic() + ANSWER_WITHIN

        def late() -> str:
            is_late = time.monotonic() > until
            too_late = f'not all obeyed within {ANSWER_WITHIN:g} s, given up' if is_late else ''
            return self._ending() or too_late

        def end(reason: str) -> None:
            reasons.append(reason)
            ended.set()

        Upload(self._request, commands, end, late).begin()
        if not ended.wait(ANSWER_WITHIN + LAST_TRIES):
            return False, f'no answer within {ANSWER_WITHIN + LAST_TRIES:g} s'
        return (False, reasons[0]) if reasons[0] else (True, done)

    def _ending(self) -> str:
        return 'the bridge ends' if self._is_closing else ''

    def _say(self, text: str) -> None:
        self.get_logger().info(text)
        self._status.publish(String(data=text))


def _columns(message: JointTrajectory, names: Sequence[str]) -> tuple[Array, Array]:
    """Times (n,) and positions (n, joints) in the order of `names`; InvalidInput otherwise."""
    if sorted(message.joint_names) != sorted(names):
        raise InvalidInput(f'joints are {list(message.joint_names)}, needs {list(names)}')
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
