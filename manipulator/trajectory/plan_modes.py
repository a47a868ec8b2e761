"""What people call each kind of plan, in motion_status."""

from manipulator.trajectory.cycle import Cycle
from manipulator.trajectory.joint_move import JointMove
from manipulator.trajectory.move import Move
from manipulator.trajectory.path_timing import TimedPath
from manipulator.trajectory.plan import Hold
from manipulator.trajectory.straight import StraightMove

MODES: dict[type, str] = {
    Hold: 'hold',
    StraightMove: 'move',
    Move: 'move',
    JointMove: 'move',
    Cycle: 'cycle',
    TimedPath: 'path',
}
