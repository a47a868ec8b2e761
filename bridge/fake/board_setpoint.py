"""What a setpoint must be before the board aims at it; ranges are in counts, by channel."""

from collections.abc import Sequence

from bridge.protocol import (
    MAX_DEADLINE_MS,
    MIN_DEADLINE_MS,
    NO_JOINT,
    Fault,
    FaultCode,
    Setpoint,
)


def setpoint_fault(setpoint: Setpoint, ranges: Sequence[tuple[int, int]]) -> Fault | None:
    """Why it must not be followed; None where it may."""
    if len(setpoint.counts) != len(ranges):
        return Fault(FaultCode.WRONG_JOINTS, NO_JOINT, len(setpoint.counts))
    if not MIN_DEADLINE_MS <= setpoint.deadline_ms <= MAX_DEADLINE_MS:
        return Fault(FaultCode.BAD_DEADLINE, NO_JOINT, setpoint.deadline_ms)
    return range_fault(setpoint.counts, ranges)


def range_fault(counts: Sequence[int], ranges: Sequence[tuple[int, int]]) -> Fault | None:
    """The first count out of its range; as many counts as ranges."""
    for i, (count, (low, high)) in enumerate(zip(counts, ranges, strict=True)):
        if not low <= count <= high:
            return Fault(FaultCode.OUT_OF_RANGE, i, count)
    return None
