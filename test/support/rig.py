"""One machine's whole graph on a board of this process: every frame and every pulse, with times.

The nodes are the shipped ones, as processes that can be killed, frozen and started again one by
one; the line is a pty. For measurements of whole graphs (bench/stop_times.py) and their tests.
"""

import bisect
import contextlib
import os
import signal
import threading
import time
from collections.abc import Mapping, Sequence
from contextlib import ExitStack
from pathlib import Path

import numpy as np
from rcl_interfaces.msg import Parameter, ParameterType, ParameterValue
from rcl_interfaces.srv import SetParameters

from bridge.fake.board_thread import BoardThread, FakeMachine
from bridge.fake.faults import Faults
from bridge.fake.servo import Plant
from bridge.servo_config import BoardConfig
from hexarm import machines
from hexarm.client import ENABLING, Client
from hexarm.graph import Graph, machine_graph
from manipulator.errors import ManipulatorError, Refused, TimedOut
from manipulator.states import MotionMode
from tapped_line import Tap, TappedLine

Pulses = tuple[float | None, ...]

TRIES = 10
PULSE_PERIOD = 0.02
FROZEN = 1.0
"""Seconds for which the servo targets must be still to be called so."""

CIRCLE = {  # 15 mm/s, and never a moment of rest
    'cycle.amplitude': [0.005, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.005, 0.0, 0.0, 0.0, 0.0],
    'cycle.frequency': [0.5] * 12,
    'cycle.phase': [0.0] * 6 + [np.pi / 2] * 6,
}


class Recorder:
    """Stands in for a FakeMachine and keeps every change of its pulses, and when it was.

    Stepped by the board's thread, read from another.
    """

    def __init__(self, machine: FakeMachine) -> None:
        self.machine = machine
        self.board, self.calibration = machine.board, machine.calibration
        self._changes = [(time.monotonic(), machine.board.pulses)]
        self._periods = [1.0]
        self._board_time = 0.0
        self._lock = threading.Lock()

    @property
    def servos(self) -> Plant:
        """The machine's."""
        return self.machine.servos

    def step(self, dt: float, stuck_channel: int | None = None) -> None:
        """As the machine does."""
        self.machine.step(dt, stuck_channel)
        self._board_time += dt
        if self.board.pulses != self._changes[-1][1]:
            with self._lock:
                self._changes.append((time.monotonic(), self.board.pulses))
                self._periods.append(max(1.0, np.ceil(self._board_time / PULSE_PERIOD)))
            self._board_time = 0.0

    def changes(self, since: float = float('-inf')) -> list[tuple[float, Pulses]]:
        """(time, pulses in counts) after every change since then, with the one before it."""
        with self._lock:
            return self._changes[self._before(since) :]

    @property
    def slew(self) -> float:
        """The most that a servo's pulse may change in one pulse period, in counts."""
        return max(self.calibration.count_speeds) * PULSE_PERIOD + 1.0

    def largest_step(self, since: float = float('-inf')) -> float:
        """The largest change of one pulse in one pulse period, in counts.

        A thread that this computer held up sees the change of several periods at once.
        """
        with self._lock:
            first = self._before(since)
            changes, periods = self._changes[first:], self._periods[first + 1 :]
        pulses = np.array([p for _, p in changes], dtype=float)  # None is NaN
        steps = np.abs(np.diff(pulses, axis=0)) / np.reshape(periods, (-1, 1))
        return float(np.nanmax(steps)) if np.isfinite(steps).any() else 0.0

    def _before(self, since: float) -> int:
        """The index of the last change before a time."""
        times = [t for t, _ in self._changes]
        return max(bisect.bisect_left(times, since) - 1, 0)

    def way(self, since: float) -> float:
        """How far any pulse has been from where it was at that time, in counts."""
        pulses = np.array([p for _, p in self.changes(since) if None not in p])
        return float(np.abs(pulses - pulses[0]).max())

    def standstill(self, since: float, quiet: float) -> float:
        """When the pulses changed for the last time, once they have been still for `quiet` s."""
        deadline = time.monotonic() + 60.0
        while time.monotonic() < deadline:
            last = self.changes(since)[-1][0]
            is_seen = self._board_time > quiet  # by the board's thread too, which may be late
            if is_seen and time.monotonic() - max(last, since) > quiet:
                return max(last, since)
            time.sleep(0.01)
        raise TimeoutError('the servo targets never came to rest')


class Rig:
    """A context manager: board, line, user, and the graph's processes by name."""

    def __init__(
        self,
        folder: Path,
        space: str,
        machine: str = 'robocake',
        boot_s: float = 0.2,
        faults: Faults | None = None,
        is_separate: bool = True,
    ) -> None:
        """`is_separate`: a process for each node, otherwise one for all four, named 'machine'."""
        config = BoardConfig.from_machine(machines.read(machine))
        self._path = folder / 'board'
        self.tap = Tap()
        self.recorder = Recorder(FakeMachine.from_config(config, boot_s, hysteresis=0.0))
        line = TappedLine(self._path, self.tap)
        self.board = BoardThread(self.recorder, line, lambda positions: None, faults)
        self.calibration = self.recorder.calibration
        self._space = space
        nodes = machine_graph(machine, str(self._path), self._path, is_separate)
        self._nodes = {node.name: node for node in nodes}
        self._graphs: dict[str, Graph] = {}
        self._stack = ExitStack()

    @property
    def names(self) -> tuple[str, ...]:
        """Of the nodes."""
        return tuple(self._nodes)

    def __enter__(self) -> 'Rig':
        with ExitStack() as stack:
            self.board.start()
            stack.callback(self.board.close)
            stack.callback(self._end_all)
            for name in self._nodes:
                self.start(name)
            self.user = stack.enter_context(Client(self._space))
            self._stack = stack.pop_all()
        return self

    def __exit__(self, *exception: object) -> None:
        self._stack.close()

    def start(self, name: str) -> None:
        """Starts a process, after the end of the one before it."""
        if name in self._graphs:
            self._graphs[name].__exit__(None, None, None)
        self._graphs[name] = Graph([self._nodes[name]], self._space).__enter__()

    def pid(self, name: str) -> int:
        """Of a node's process."""
        return self._graphs[name].pids()[name]

    def dead(self) -> list[str]:
        """A text for each process that ended by itself."""
        return [words for graph in self._graphs.values() if (words := graph.dead())]

    def send(self, name: str, number: int) -> float:
        """Sends a signal to one process and returns when."""
        before = time.monotonic()
        os.kill(self.pid(name), number)
        return before

    def pull(self) -> float:
        """Pulls the cable and returns when."""
        before = time.monotonic()
        self.board.do(lambda: self.board.plug(None))
        return before

    def plug(self) -> None:
        """Puts the cable back: the board starts again."""
        line = TappedLine(self._path, self.tap)
        self.board.do(lambda: self.board.plug(line))

    def enable(self) -> None:
        """Repeats a request where the bridge has ended, or lost its board on a busy computer."""
        for _ in range(TRIES):
            with contextlib.suppress(TimedOut, Refused):
                self.user.enable()
                return
        raise TimedOut(f'not enabled in {TRIES} tries: {self.user.summary}')

    def circle(self, seconds: float) -> None:
        """Has the platform circle about home for a while; again, where this computer stalls."""
        last: ManipulatorError | None = None
        for _ in range(TRIES):
            try:
                if self.user.machine_state.message not in ENABLING:
                    self.enable()
                self.set_parameters('trajectory', CIRCLE)
                self.user.wait(
                    'goals', lambda: self.user.motion('mode') != MotionMode.DISABLED, 5.0
                )
                self.user.home()
                self.user.trigger('trajectory/start_cycle')
                self.user.wait(
                    'the circle', lambda: self.user.motion('mode') == MotionMode.CYCLE, 3.0
                )
                self.user.spin(seconds)
                if self.user.motion('mode') == MotionMode.CYCLE:
                    return
            except ManipulatorError as error:
                last = error
        raise TimedOut(f'no circle in {TRIES} tries ({last}): {self.user.summary}')

    def stop_time(self, name: str, number: int) -> float:
        """Seconds from a signal to a process until the servo targets are at rest."""
        signalled = self.send(name, number)
        # Nothing but the signal must move them afterwards: receive nothing, request nothing.
        return self.recorder.standstill(signalled, FROZEN) - signalled

    def set_parameters(self, node: str, values: Mapping[str, Sequence[float]]) -> None:
        """Of a node; TimedOut where it refuses one."""
        kind = ParameterType.PARAMETER_DOUBLE_ARRAY
        request = SetParameters.Request(
            parameters=[
                Parameter(name=name, value=ParameterValue(type=kind, double_array_value=value))
                for name, value in values.items()
            ]
        )
        client = self.user.node.create_client(SetParameters, f'{node}/set_parameters')
        self.user.wait('the parameter service', client.service_is_ready, 10.0)
        future = client.call_async(request)
        self.user.wait('the parameters', future.done, 3.0)
        self.user.node.destroy_client(client)
        refused = [r.reason for r in future.result().results if not r.successful]
        if refused:
            raise TimedOut(f'{node}: {refused[0]}')

    def _end_all(self) -> None:
        for name in self._graphs:
            # A frozen process receives nothing else.
            if self._graphs[name].dead() is None:
                self.send(name, signal.SIGCONT)
        for graph in reversed(self._graphs.values()):
            graph.__exit__(None, None, None)
