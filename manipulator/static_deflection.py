"""Static deflection: how far drives yield under gravity, where only their commands are known.

Commands to the board are raised by it, reported joints are lowered: all other code uses the joints
where they are.
"""

from collections.abc import Callable

from manipulator.arrays import Array
from manipulator.kinematics import ForwardSolution, Kinematics
from manipulator.pose import Pose

StaticDeflection = Callable[[Pose, Array], Array]
"""How far (n,) the drives stay behind their commands, for a pose and its joints (n,)."""


def commanded(deflection: StaticDeflection | None, pose: Pose, joints: Array) -> Array:
    """The command (n,) under which the joints end at `joints`, those of `pose`."""
    return joints if deflection is None else joints + deflection(pose, joints)


def joints_under(deflection: StaticDeflection | None, pose: Pose, command: Array) -> Array:
    """The joints (n,) that a command (n,) leads to, near a pose.

    The deflection there is taken for that at the command: a difference of second order.
    """
    return command if deflection is None else command - deflection(pose, command)


def deflected(
    deflection: StaticDeflection | None,
    kinematics: Kinematics,
    command: Array,
    solution: ForwardSolution,
) -> ForwardSolution:
    """The pose under a command (n,) whose own forward solution is `solution`.

    NoSolution as `Kinematics.forward`.
    """
    if deflection is None:
        return solution
    return kinematics.forward(joints_under(deflection, solution.pose, command), solution.pose)
