"""Starting the processes of one machine's graph, watching them, and stopping them all."""

import ctypes
import os
import re
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

from bridge.fake.servo import SERVO
from hexarm.board.build import chip_command
from hexarm.machines import read
from manipulator.errors import ManipulatorError, Refused

PATIENCE = 5.0
"""Seconds a process has for its own clean end before it is killed."""

PR_SET_PDEATHSIG = 1


@dataclass(frozen=True)
class Executable:
    """One process: the name in hexarm/nodes.py, its own parameters, the file it waits for.

    `command` is what runs it instead of `python -m hexarm.nodes NAME`; `prefix` precedes the
    command, as in `ip netns exec far`.
    """

    name: str
    parameters: dict[str, str] = field(default_factory=dict)
    needs: Path | None = None
    command: tuple[str, ...] = ()
    prefix: tuple[str, ...] = ()


def machine_graph(
    machine: str, port: str, link: Path, is_separate: bool = False
) -> list[Executable]:
    """The processes of a machine: one for its four nodes, or one for each where `is_separate`.

    Before them the board of port 'fake' or 'simavr', whose port appears at `link`.
    """
    boards = board_process(machine, port, link)
    needs = link if boards else None
    if is_separate:
        return [*boards, *node_processes(machine, port, needs)]
    parameters = {'machine': machine, 'port': str(needs or port)}
    return [*boards, Executable('machine', parameters, needs)]


def node_processes(machine: str, port: str, link: Path | None = None) -> list[Executable]:
    """A process for each node of a machine, on a port or on the link that a fake board makes."""
    common = {'machine': machine}
    nodes = [Executable(name, common) for name in ('ik', 'pose', 'trajectory')]
    return [*nodes, Executable('serial_bridge', common | {'port': str(link or port)}, link)]


def board_process(machine: str, port: str, link: Path, plant: str = SERVO) -> list[Executable]:
    """The fake board for port 'fake', the firmware on a simulated chip for 'simavr', or none.

    plant: what its pulses move, 'servo' or 'mujoco'. Refused for a device, which moves its own.
    A machine that other software drives has no board: see `check_topic`.
    """
    if read(machine).driver == 'topic':
        check_topic(machine, port, plant)
        return []
    parameters = {'machine': machine, 'link': str(link), 'plant': plant}
    if port == 'fake':
        return [Executable('fake_hardware', parameters)]
    if port == 'simavr':
        return [Executable('fake_hardware', parameters, command=chip_command(machine))]
    if plant != SERVO:
        raise Refused(f'--plant {plant}: for port fake or simavr; {port} moves a real machine')
    return []


def check_topic(machine: str, port: str, plant: str = SERVO) -> None:
    """Refused for what is neither 'fake' nor the topic where a driver reports its joints."""
    if plant != SERVO:
        raise Refused(f'--plant {plant}: {machine} has driver: topic, and no board to simulate')
    if port.startswith('/dev/') or TOPIC.fullmatch(port) is None or port == 'simavr':
        raise Refused(
            f'port {port}: {machine} has driver: topic, and no board; it needs the topic of its '
            "driver's joint states, as in --port /joint_states, or 'fake' for a simulated one"
        )


TOPIC = re.compile(r'/?[A-Za-z_]\w*(/[A-Za-z_]\w*)*')


class Graph:
    """The running processes; a context manager that leaves none behind."""

    def __init__(
        self, nodes: Sequence[Executable], namespace: str, log_level: str = 'info'
    ) -> None:
        self._nodes = nodes
        self._log_level = log_level
        self._namespace = namespace
        self._processes: dict[str, subprocess.Popen[bytes]] = {}

    def __enter__(self) -> 'Graph':
        """Starts every node."""
        for node in self._nodes:
            wait_for(node.needs)
            self._processes[node.name] = subprocess.Popen(
                [*node.prefix, *_command(node, self._namespace, self._log_level)],
                start_new_session=True,
                stdin=subprocess.DEVNULL,
                preexec_fn=_die_with_parent,  # noqa: PLW1509 (one prctl call, no threads yet)
                env=environment(),
            )
        return self

    def __exit__(self, *exception: object) -> None:
        """Stops every node, the board last: by a signal first, killed where that does not help."""
        deadline = time.monotonic() + PATIENCE
        for process in reversed(self._processes.values()):
            process.terminate()
            try:
                process.wait(max(0.1, deadline - time.monotonic()))
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()

    def dead(self) -> str | None:
        """The name of a node that has ended, with its exit status."""
        for name, process in self._processes.items():
            status = process.poll()
            if status is not None:
                return f'{name} ended with status {status}'
        return None

    def pids(self) -> dict[str, int]:
        """The process number of each node."""
        return {name: process.pid for name, process in self._processes.items()}


class NodeDied(ManipulatorError):
    """A node of the graph has ended by itself."""


def check_alive(graph: Graph) -> None:
    """Raises NodeDied when a process of the graph has ended."""
    dead = graph.dead()
    if dead is not None:
        raise NodeDied(f'{dead}; stopping the others')


def link_folder() -> 'tempfile.TemporaryDirectory[str]':
    """A private folder for the fake board's port."""
    return tempfile.TemporaryDirectory(prefix='hexarm-')


def wait_for(path: Path | None) -> None:
    """Waits for a file that a process makes, PATIENCE at most."""
    deadline = time.monotonic() + PATIENCE
    while path is not None and not path.exists() and time.monotonic() < deadline:
        time.sleep(0.01)


def _command(node: Executable, namespace: str, log_level: str) -> list[str]:
    words = node.command or (sys.executable, '-m', 'hexarm.nodes', node.name)
    return [*words, *ros_arguments(namespace, node.parameters), '--log-level', log_level]


def ros_arguments(namespace: str, parameters: dict[str, str]) -> list[str]:
    """The arguments that put every node of a process there, with these parameters."""
    words = ['--ros-args', '-r', f'__ns:=/{namespace.strip("/")}']
    for name, value in parameters.items():
        words += ['-p', f'{name}:={value}']
    return words


def environment() -> dict[str, str]:
    """Ours, with the source tree importable where nothing is installed."""
    here = str(Path(__file__).resolve().parent.parent)
    known = [p for p in os.environ.get('PYTHONPATH', '').split(os.pathsep) if p]
    return os.environ | {'PYTHONPATH': os.pathsep.join([here, *known])}


def _die_with_parent() -> None:
    """Has the kernel end the node when this process dies without stopping it."""
    ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGTERM)
