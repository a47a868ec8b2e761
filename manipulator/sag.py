"""Servos that report commands, not positions, sag under gravity by an amount that is known.

What goes down to the board is raised by it, what comes up is lowered: above, everybody means
where the joints are.
"""

from collections.abc import Callable

from manipulator.arrays import Array
from manipulator.kinematics import ForwardSolution, Kinematics
from manipulator.pose import Pose

Sag = Callable[[Pose, Array], Array]
"""By how much (n,) the drives stay behind their commands, for a pose and its joints (n,)."""


def commanded(sag: Sag | None, pose: Pose, joints: Array) -> Array:
    """What to command so that the joints end at `joints`, which make `pose`."""
    return joints if sag is None else joints + sag(pose, joints)


def settled(
    sag: Sag | None, kinematics: Kinematics, command: Array, solution: ForwardSolution
) -> ForwardSolution:
    """Where the machine stands under a command (n,) whose own forward solution is `solution`.

    The sag there is taken for that at the command: a difference of second order. NoSolution as
    `Kinematics.forward`.
    """
    if sag is None:
        return solution
    return kinematics.forward(command - sag(solution.pose, command), solution.pose)
