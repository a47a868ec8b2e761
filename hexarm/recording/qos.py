"""The quality of service of a recorder's subscriptions, and the offered one as metadata."""

from collections.abc import Sequence

import yaml
from rclpy.duration import Duration
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy

DEPTH = 500
"""Messages that may wait: half a second of the fastest topic on a busy computer."""


def subscription_qos(
    publishers: Sequence[QoSProfile], subscribers: Sequence[QoSProfile]
) -> QoSProfile:
    """What every publisher can serve; before there is one, what other subscribers request."""
    offers = publishers or subscribers
    every = all if publishers else any
    is_reliable = every(o.reliability == ReliabilityPolicy.RELIABLE for o in offers)
    is_latched = every(o.durability == DurabilityPolicy.TRANSIENT_LOCAL for o in offers)
    return QoSProfile(
        depth=DEPTH,
        reliability=ReliabilityPolicy.RELIABLE if is_reliable else ReliabilityPolicy.BEST_EFFORT,
        durability=DurabilityPolicy.TRANSIENT_LOCAL if is_latched else DurabilityPolicy.VOLATILE,
    )


def offered(publishers: Sequence[QoSProfile]) -> str:
    """The publishers' profiles as YAML with the names of rosbag2's metadata, version 9."""
    different = {str(offer): offer for offer in map(_as_metadata, publishers)}
    return yaml.safe_dump(list(different.values()), sort_keys=False) if different else ''


def _as_metadata(profile: QoSProfile) -> dict[str, object]:
    # Discovery provides neither history nor depth: at least one message must be kept.
    return {
        'history': 'keep_last',
        'depth': max(profile.depth, 1),
        'reliability': profile.reliability.name.lower(),
        'durability': profile.durability.name.lower(),
        'deadline': _span(profile.deadline),
        'lifespan': _span(profile.lifespan),
        'liveliness': profile.liveliness.name.lower(),
        'liveliness_lease_duration': _span(profile.liveliness_lease_duration),
        'avoid_ros_namespace_conventions': bool(profile.avoid_ros_namespace_conventions),
    }


def _span(duration: Duration) -> dict[str, int]:
    sec, nsec = divmod(duration.nanoseconds, 10**9)
    return {'sec': sec, 'nsec': nsec}
