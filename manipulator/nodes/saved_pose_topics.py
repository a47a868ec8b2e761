"""The part of the pose node that keeps saved poses: `save_pose`, `delete_pose`, `saved_poses`.

The poses are in a file beside the machine's, which a user may edit meanwhile.
"""

import os
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from rclpy.node import Node
from std_msgs.msg import String
from std_srvs.srv import Trigger

from manipulator.arrays import Array
from manipulator.config import MAX_CHARACTERS
from manipulator.deadlines import POSE_DEADLINE
from manipulator.errors import ConfigError, InvalidInput, ManipulatorError
from manipulator.formatting import reason
from manipulator.machine import Machine
from manipulator.nodes.qos import EVERY_WORD, LATCHED
from manipulator.nodes.subscriptions import decoded
from manipulator.pose import Pose
from manipulator.saved_poses import SavedPose, SavedPoses

MOST_BYTES = 1000
"""Of a message that holds a name."""


class SavedPoseTopics:
    """Topics `save_pose`, `delete_pose`, `saved_poses`, `saved_pose_status`, service `~/save`."""

    def __init__(self, node: Node, machine: Machine, path: Path) -> None:
        self._node, self._path = node, path
        self._empty = self._saved = SavedPoses.none_of(machine)
        self._changed_at: int | None = None
        self._problem = ''
        self._last: SavedPose | None = None
        self._last_at = float('-inf')
        self._texts = node.create_publisher(String, 'saved_poses', LATCHED)
        self._outcomes = node.create_publisher(String, 'saved_pose_status', LATCHED)
        self._outcomes.publish(String())  # with it a client tells an answer from an older outcome
        for topic, change in (('save_pose', self._save), ('delete_pose', self._delete)):
            node.create_subscription(String, topic, self._named(change), EVERY_WORD, raw=True)
        node.create_service(Trigger, '~/save', self._on_save)
        self.watch()

    def note(self, pose: Pose, joints: Array) -> None:
        """The measured pose, and its joints (n,)."""
        self._last, self._last_at = SavedPose(pose, joints), time.monotonic()

    def watch(self) -> str:
        """Reads the file again if it has changed; returns what is wrong with it, or ''."""
        try:
            changed_at = os.stat(self._path).st_mtime_ns
        except FileNotFoundError:
            changed_at = 0
        except OSError as error:
            return f'{self._path} cannot be read: {reason(error)}'
        if changed_at != self._changed_at:
            self._changed_at = changed_at
            self._read(changed_at != 0)
        return self._problem

    def _read(self, is_there: bool) -> None:
        self._problem = ''
        try:
            text = self._text() if is_there else self._empty.text
            self._saved = self._empty.read(text, str(self._path))
        except ConfigError as error:
            self._problem = str(error)
            self._node.get_logger().warning(self._problem)
        self._texts.publish(String(data=self._saved.text))

    def _text(self) -> str:
        try:
            text = self._path.read_text(encoding='utf-8')
        except (OSError, UnicodeDecodeError) as error:
            raise ConfigError([f'cannot be read: {reason(error)}'], str(self._path)) from error
        if len(text) > MAX_CHARACTERS:
            raise ConfigError([f'{len(text)} characters, at most {MAX_CHARACTERS}'])
        return text

    def _named(self, change: Callable[[str], str]) -> Callable[[bytes], None]:
        def receive(serialized: bytes) -> None:
            name = ''
            try:
                name = decoded(serialized, String, MOST_BYTES).data
                outcome = change(name)
            except ManipulatorError as error:
                outcome = f'{name}: refused: {error}'
            self._report(outcome)

        return receive

    def _on_save(self, request: Any, response: Any) -> Any:
        try:
            response.message, response.success = self._save(''), True
        except ManipulatorError as error:
            response.message = str(error)
        else:
            self._report(response.message)
        return response

    def _report(self, outcome: str) -> None:
        self._node.get_logger().info(f'saved poses: {outcome}')
        self._outcomes.publish(String(data=outcome))

    def _save(self, name: str) -> str:
        if self._last is None or time.monotonic() - self._last_at > POSE_DEADLINE:
            raise InvalidInput('no pose: not all joints are known (servos off?)')
        self._check_file()
        name = name or self._saved.free_name()
        word = 'replaced' if name in self._saved.poses else 'saved'
        self._keep(self._saved.with_pose(name, self._last))
        return f'{name}: {word}'

    def _delete(self, name: str) -> str:
        self._check_file()
        self._keep(self._saved.without(name))
        return f'{name}: deleted'

    def _check_file(self) -> None:
        """A file that cannot be read is not overwritten."""
        problem = self.watch()
        if problem:
            raise InvalidInput(problem)

    def _keep(self, saved: SavedPoses) -> None:
        """Writes the file as a whole, under another name first: a crash leaves the old one."""
        draft = self._path.with_name(f'.{self._path.name}.{os.getpid()}')
        try:
            self._path.parent.mkdir(parents=True, exist_ok=True)
            draft.write_text(saved.text, encoding='utf-8')
            draft.replace(self._path)
        except OSError as error:
            raise InvalidInput(f'{self._path} cannot be written: {reason(error)}') from error
        self._changed_at = None
        self.watch()
