"""Whether anybody hears what a person's hands ask for, in one line whenever that changes."""

from dataclasses import dataclass, field

from rclpy.node import Node

PATIENCE = 3.0
"""Seconds that nodes may take to find each other."""


def place(node: Node) -> str:
    """Where a node looks for others, as '/hexapod on ROS domain 0'."""
    return f'{node.get_namespace()} on ROS domain {node.context.get_domain_id()}'


@dataclass
class Audience:
    """What is to be said of the listeners in `place`; times are monotonic, in seconds."""

    place: str
    since: float
    said: bool | None = field(default=None, init=False)

    def news(self, is_heard: bool, now: float) -> str:
        """A line when somebody begins to listen, or has not for a while; '' at other times."""
        if is_heard:
            self.since = now
        is_new = is_heard is not self.said
        if not is_new or (not is_heard and now - self.since < PATIENCE):
            return ''
        self.said = is_heard
        if is_heard:
            return f'a machine listens in {self.place}'
        return f'nobody listens in {self.place}: is a graph up there? {self._hint}'.rstrip()

    @property
    def _hint(self) -> str:
        is_root = self.place.startswith('/ ')
        return 'Another namespace: --ros-args -r __ns:=/hexapod' if is_root else ''
