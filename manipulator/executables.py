"""The room's executable: `joy_teleop`."""

from manipulator.nodes.run import run_node


def joy_teleop() -> int:
    """From Joy messages to twists."""
    from hexarm.gamepads import load  # noqa: PLC0415 (each imports its own node)
    from manipulator.nodes.joy_teleop_node import JoyTeleop  # noqa: PLC0415

    return run_node(lambda: JoyTeleop(load))
