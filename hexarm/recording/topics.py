"""Which topics are recorded, from when on, and which of them are missing, with the reason."""

import difflib
from collections.abc import Collection, Sequence
from dataclasses import dataclass, field

from hexarm.namespaces import no_machine_in

SHARED = ('/diagnostics', '/rosout', '/tf', '/tf_static')
"""Topics of all machines, without which a recording of one is poorer."""

COMMANDS = frozenset(
    (
        *('goal_pose', 'goal_path', 'jog_mode', 'look_at', 'speed_override', 'pivot', 'tool'),
        *('goal_joints', 'joint_trajectory'),
        *('cmd_vel', 'cmd_vel/joy', 'cmd_vel/panel', 'cmd_vel/keyboard'),
        *('cmd_joints', 'cmd_joints/joy', 'cmd_joints/panel', 'cmd_joints/keyboard'),
        *('gripper', 'emergency_stop', 'joint_table', 'joy', 'save_pose', 'delete_pose'),
    )
)
"""What users publish, and the machine's nodes only receive."""

ALL_FOUND_AFTER = 5.0
"""Seconds after which a publisher has found all its subscribers."""

GOALS, CAREFUL = ('goal_pose', 'goal_path', 'goal_joints'), frozenset(('hexarm', 'panel'))
"""Commands that these nodes publish once they have found the machine, not any subscriber."""


@dataclass
class TopicSelection:
    """The topics of `namespace`, or only `names` (relative ones are the namespace's).

    A command is joined only once its publisher has been there for ALL_FOUND_AFTER. Many a script
    publishes once, for the first subscriber; a recorder that subscribed before would sometimes be
    taken for the machine, and the goal, or the stop, would reach no other node. With
    `with_commands`, for a requested name, and for GOALS of CAREFUL nodes, it is joined at once.
    """

    namespace: str
    names: Sequence[str] = ()
    with_commands: bool = False
    _since: dict[str, float] = field(default_factory=dict)

    def __post_init__(self) -> None:
        """Makes the names absolute."""
        space = f'/{self.namespace.strip("/")}/'
        self._space = space
        self.names = tuple(n if n.startswith('/') else space + n for n in self.names)

    def is_own(self, topic: str) -> bool:
        """Whether the topic is what the recording is made for: not one that all machines share."""
        return topic in self.names if self.names else topic.startswith(self._space)

    def is_command(self, topic: str) -> bool:
        """Whether users publish the topic, and not the machine."""
        return topic.removeprefix(self._space) in COMMANDS

    def may_join(self, topic: str, publishers: Collection[str], now: float) -> bool:
        """Whether to subscribe to the topic from now (s, monotonic) on; `publishers`: nodes."""
        if self.names:
            return topic in self.names
        if topic in SHARED:
            return True
        if not topic.startswith(self._space):
            return False
        if self.with_commands or not self.is_command(topic):
            return True
        if not publishers:
            self._since.pop(topic, None)
            return False
        has_found_all = now - self._since.setdefault(topic, now) >= ALL_FOUND_AFTER
        is_goal = topic.removeprefix(self._space) in GOALS
        return has_found_all or (is_goal and CAREFUL.issuperset(publishers))


NEAREST = 3


def missing_topics(
    names: Sequence[str], received: Collection[str], there: Collection[str]
) -> list[str]:
    """One line for each of the requested topics that is not among those `received`."""
    lines = []
    for name in sorted(set(names) - set(received)):
        if name in there:
            lines.append(f'{name} exists, but nothing was published on it')
        else:
            lines.append(f'there is no topic {name}{_near(name, there)}')
    return lines


def nothing_recorded(
    namespace: str, lines: Sequence[str], there: Collection[str], domain: int
) -> str:
    """Why no message was received: the `lines` of requested topics, or there is no machine."""
    if any(topic.startswith(f'/{namespace}/') for topic in there):
        return '; '.join(lines) or f'nothing was published in /{namespace}'
    reason = no_machine_in(namespace, there, domain)
    return '; '.join([reason, *lines])


def _near(name: str, there: Collection[str]) -> str:
    """Compared without the namespace that they share, which would make all of them alike."""
    space = name[: name.find('/', 1) + 1]
    inside = {topic.removeprefix(space): topic for topic in there if topic.startswith(space)}
    near = difflib.get_close_matches(name.removeprefix(space), inside, n=NEAREST)
    return f', did you mean {" or ".join(inside[n] for n in near)}?' if near else ''
