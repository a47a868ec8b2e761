"""Deadlines that must agree across nodes, in seconds; docs/safety.md describes their effects.

A deadline is kept on the monotonic clock of its receiver.
"""

MESSAGE_AGE = 0.5
"""Age of a message, by its stamp, above which it is rejected."""

POSE_PAUSE = 0.2
"""Seconds without `pose` after which the active plan brakes."""

POSE_DEADLINE = 0.5
"""Seconds without `pose`, or of a stalled control loop, after which the machine is released."""

FOLLOWING_PATIENCE = 0.3
"""Seconds for which the following error may exceed its tolerance."""

STATE_PERIOD = 0.5
"""Seconds between two `machine_state` while nothing changes."""

STATE_DEADLINE = 3 * STATE_PERIOD
"""Seconds without `machine_state` after which the last one is discarded."""

BOARD_DEADLINE = 0.5
"""Seconds without a frame of the board after which the machine is disconnected."""

RELEASE = 0.25
"""Seconds without a twist after which a source has released the machine.

The page's heartbeat and the gamepad's confirmation of a stop have the same deadline.
"""

HAND_OVER = RELEASE + 0.05
"""Seconds without a twist after which the source that released may command a goal."""

COMMAND_MEMORY = 0.25
"""Seconds after which a joint command is no longer taken as the joints' position."""
