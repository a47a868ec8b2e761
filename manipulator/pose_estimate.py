"""Where the platform or tool is, from joints that are reported one after the other."""

from collections.abc import Callable

from manipulator.arrays import Array
from manipulator.errors import NoSolution
from manipulator.kinematics import ForwardSolution
from manipulator.machine import Machine
from manipulator.static_deflection import deflected

AFRESH = 'the last pose does not lead to the present one: afresh'


class PoseEstimate:
    """One machine's pose in the base frame, solved warm from the last one where that leads there.

    solution: that of the last joints, None where these were not all known or led to no pose.
    """

    def __init__(self, machine: Machine, note: Callable[[str], object] = str) -> None:
        """note: is called when the last pose did not lead to the present one."""
        self.solution: ForwardSolution | None = None
        self._machine = machine
        self._note = note

    def update(self, joints: Array | None) -> ForwardSolution | None:
        """The pose for joints (n,), None where not all of them are known.

        Raises NoSolution, and LimitViolated where the pose can only be found from home and lies
        beyond a limit: it may be another assembly mode's.
        """
        near, self.solution = self.solution, None
        if joints is None:
            return None
        found = self.solution = self._warm(joints, near) or self._cold(joints)
        self.solution = deflected(
            self._machine.deflection, self._machine.kinematics, joints, found
        )
        return self.solution

    def _warm(self, joints: Array, near: ForwardSolution | None) -> ForwardSolution | None:
        if near is None:
            return None
        try:
            return self._machine.kinematics.forward(joints, near.pose)
        except NoSolution:
            self._note(AFRESH)
            return None

    def _cold(self, joints: Array) -> ForwardSolution:
        """From home; a solution that took no iteration is explicit, and the only one."""
        solution = self._machine.kinematics.forward(joints)
        if solution.iterations > 0:
            self._machine.constraints.check(solution.pose, joints)
        return solution
