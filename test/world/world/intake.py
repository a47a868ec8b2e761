"""What every subscription does with a message (manipulator/nodes/intake.py), without ROS."""

from manipulator.errors import ManipulatorError
from manipulator.stamps import StampGate


class Intake:
    """Refuses what is stale; keeps why something was refused, and when the last good one came."""

    def __init__(self, process, accept, refuse=lambda stamp, error: None):
        self.refusals = []
        self.last_good = float('-inf')
        self._process, self._accept, self._refuse = process, accept, refuse
        self._gate = StampGate()

    def __call__(self, stamp, *value):
        try:
            self._gate.admit(stamp, self._process.now)
            self._accept(stamp, *value)
        except ManipulatorError as error:
            self.refusals.append((self._process.now, str(error)))
            self._refuse(stamp, error)
        else:
            self.last_good = self._process.now

    @property
    def age(self):
        return self._process.now - self.last_good
