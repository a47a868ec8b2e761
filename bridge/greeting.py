"""What a HELLO tells: whether the board fits, and whether it has started again."""

from bridge.messages import PROTOCOL_VERSION, Hello
from manipulator.words import counted

UPTIME_SLACK_MS = 250
SHORTEST_ADVANCE_MS = 125


def misfit(hello: Hello, joint_count: int) -> str:
    """Why a board must not be talked to, '' where it fits a machine of `joint_count` joints."""
    if hello.version != PROTOCOL_VERSION:
        return f'the board speaks protocol {hello.version}, this host {PROTOCOL_VERSION}'
    if hello.joint_count != joint_count:
        return f'the board has {counted(hello.joint_count, "joint")}, the machine {joint_count}'
    return ''


def has_restarted(before: Hello, hello: Hello, elapsed: float) -> bool:
    """Whether the board's clock (it wraps) ran less than half as long as ours since its HELLO.

    elapsed: seconds between the two. A board's resonator is off by a percent, and a simulated
    board may stall: neither counts. Two HELLOs of one run are 250 ms apart on that clock, so less
    is a restart as well.
    """
    advance = hello.uptime_ms - before.uptime_ms & 0xFFFF_FFFF
    is_too_slow = advance + UPTIME_SLACK_MS < 1000 * elapsed / 2
    return is_too_slow or advance < SHORTEST_ADVANCE_MS or advance >= 0x8000_0000
