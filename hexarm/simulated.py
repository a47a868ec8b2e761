"""`Robot.simulated`: a Robot that starts the graph of its machine, with a fake board."""

import os
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path

import rclpy

from hexarm import use_own_domain
from hexarm.graph import Graph, check_alive, link_folder, machine_graph
from hexarm.machines import family
from hexarm.robot import Robot
from hexarm.robot_values import FileName, checked_file


class SimulatedRobot(Robot):
    """See `Robot.simulated`."""

    def __init__(self, machine: FileName, namespace: str | None) -> None:
        self._stack = ExitStack()
        self._graph: Graph | None = None
        space = family(checked_file(machine)) if namespace is None else namespace
        with own_domain():
            super().__init__(space, machine=machine)

    def _start(self) -> None:
        self._client.refuse_second()
        folder = Path(self._stack.enter_context(link_folder()))
        nodes = machine_graph(str(self._file), 'fake', folder / 'board')
        graph = Graph(nodes, self.namespace, log_level='error')
        self._graph = self._stack.enter_context(graph)

    def _check(self) -> None:
        if self._graph is not None:
            check_alive(self._graph)

    def _leave(self) -> None:
        self._graph = None
        with self._stack:
            super()._leave()


@contextmanager
def own_domain() -> Iterator[None]:
    """Nobody else is on the ROS domain of what starts here, unless the user has chosen one.

    Where ROS runs in this process already, its domain is used.
    """
    before = dict(os.environ)
    if not rclpy.ok():
        use_own_domain()
    try:
        yield
    finally:
        for name in os.environ.keys() - before.keys():
            del os.environ[name]
        os.environ.update(before)
