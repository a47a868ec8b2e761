"""Where the messages of a machine go: into a file (Bag), or to a viewer (FoxgloveServer)."""

from collections import Counter
from dataclasses import dataclass
from typing import Protocol


@dataclass(frozen=True)
class Topic:
    """A topic as its publishers offer it; `qos` and `type_hash` as rosbag2 keeps them."""

    name: str
    type_name: str
    qos: str = ''
    type_hash: str = ''


class Sink(Protocol):
    """Takes messages as they came, in CDR; `counts` of them by topic."""

    counts: Counter[str]

    def add_type(self, type_name: str) -> None:
        """Makes a message type known; UnknownType where its definition is not installed."""

    def add_topic(self, topic: Topic) -> None:
        """Makes a topic known, whose type is."""

    def write(self, topic: str, message: bytes, at: int) -> None:
        """Takes a serialized message that was received at that time, ns since 1970."""

    def flush(self) -> None:
        """Keeps nothing back."""
