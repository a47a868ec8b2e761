"""Messages without a bound on their length, refused by their size before anything decodes them.

Decoding one of megabytes takes a second in which no other thread of the process gets a turn, one
that hears a STOP among them. For subscriptions with `raw=True`.
"""

from typing import Any

from rclpy.serialization import deserialize_message

from manipulator.errors import InvalidInput
from manipulator.words import counted


def decoded(serialized: bytes, kind: type, most_bytes: int) -> Any:
    """The message; InvalidInput where it is too large, or no message of this kind."""
    if len(serialized) > most_bytes:
        raise InvalidInput(f'{len(serialized)} bytes, at most {most_bytes}')
    try:
        return deserialize_message(serialized, kind)
    except RuntimeError as error:  # what rclpy's own error derives from
        raise InvalidInput(
            f'{counted(len(serialized), "byte")} that are no {kind.__name__}'
        ) from error
