"""The stages of a walk through the servos, and what follows on what."""

import enum


class Stage(enum.Enum):
    """What is asked of the person now."""

    DIRECTION = 'direction'
    CENTRE = 'centre'
    SCALE = 'scale'
    RANGE = 'range'
    RETURN = 'return'
    REVIEW = 'review'
    WRITE = 'write'
    LEAVE = 'leave'


AFTER = {
    Stage.DIRECTION: Stage.CENTRE,
    Stage.CENTRE: Stage.SCALE,
    Stage.SCALE: Stage.RANGE,
    Stage.RANGE: Stage.RETURN,
}
