"""How far the machine is behind a stream of goals that asks for more than it can do."""

from math import degrees

import numpy as np

from manipulator.errors import Refused
from manipulator.trajectory.pilot import Pilot


def lag_of(pilot: Pilot) -> dict[str, float]:
    """From the commanded pose to the newest goal: `lag_mm` and `lag_deg`, 0 where there is none.

    The newest goal is always the one pursued; those in between were dropped.
    """
    way = np.zeros(6)
    try:
        goal = pilot.player.pursued
    except Refused:
        goal = None
    if goal is not None:
        way = pilot.player.state.pose.twist_to(goal)
    shift, turn = (float(np.linalg.norm(part)) for part in (way[:3], way[3:]))
    return {'lag_mm': 1e3 * shift, 'lag_deg': degrees(turn)}
