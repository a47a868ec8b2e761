"""What each joint's command must be ahead of it, learned for both directions of its motion.

Gears with play leave a joint behind by half of the play, on the side that it comes from. With one
offset for each direction, it need not be learned again at every reversal.
"""

import numpy as np

from manipulator.arrays import Array, Mask


class Play:
    """Offsets (n,) of one machine's joints, rad or m.

    turn (n,): how far a joint moves before its direction has changed; most (n,): the largest
    offset. As long as an offset is not known, it is taken for the opposite of the other one.
    """

    def __init__(self, turn: Array, most: Array) -> None:
        self._turn, self._most = np.maximum(turn, 1e-6), most
        self._offsets = np.zeros((2, len(most)))
        self._is_known = np.zeros((2, len(most)), dtype=np.bool_)
        self._direction = np.zeros(len(most), dtype=np.intp)
        self._columns = np.arange(len(most))
        self._extreme: Array | None = None

    @property
    def offset(self) -> Array:
        """The offsets (n,) for the present directions."""
        chosen: Array = self._offsets[self._direction, self._columns]
        return chosen

    def move(self, joints: Array) -> None:
        """Notes the reference joints (n,) of this tick: they show the directions."""
        before = self._extreme_or(joints)
        furthest = np.where(
            self._direction == 0, np.maximum(before, joints), np.minimum(before, joints)
        )
        is_turned = np.abs(joints - furthest) > self._turn
        self._extreme = np.where(is_turned, joints, furthest)
        if is_turned.any():
            self._turn_round(is_turned, self._other)

    def face(self, rows: Array) -> None:
        """Takes the directions in which joints (k, n) begin to move, before they do."""
        away = rows - rows[0]
        has_moved = np.abs(away) > self._turn
        first = away[np.argmax(has_moved, axis=0), self._columns]
        ahead = np.where(first > 0.0, 0, 1)
        self._extreme = rows[0]
        self._turn_round(has_moved.any(axis=0) & (ahead != self._direction), self._other)

    def next_turns(self, rows: Array) -> tuple[Array, Array]:
        """At which of joints (k, n) to come each joint turns, k where none does; and its play."""
        sign = np.where(self._direction == 0, 1.0, -1.0)
        ahead = sign * rows
        furthest = np.maximum.accumulate(np.maximum(ahead, sign * self._extreme_or(rows[0])))
        has_turned = furthest - ahead > self._turn
        first = np.where(has_turned.any(axis=0), np.argmax(has_turned, axis=0), len(rows))
        return first, self._other - self.offset

    def add(self, change: Array, is_still: Mask) -> None:
        """Changes the offsets of the present directions by (n,), up to the largest.

        A joint that stands still (n,) and has gone too far, by more than what makes a turn, is
        approached from the other side.
        """
        own = np.clip(self.offset + change, -self._most, self._most)
        self._offsets[self._direction, self._columns] = own
        is_back = np.where(self._direction == 0, change, -change) < -self._turn
        if (is_still & is_back).any():
            pick = np.where(
                self._direction == 0, np.minimum(own, self._other), np.maximum(own, self._other)
            )
            self._turn_round(is_still & is_back, pick)

    def confirm(self, is_met: Mask) -> None:
        """Joints (n,) that have arrived: their offsets, where not zero, are known from now on."""
        self._is_known[self._direction, self._columns] |= is_met & (self.offset != 0.0)

    def _extreme_or(self, joints: Array) -> Array:
        return joints if self._extreme is None else self._extreme

    @property
    def _other(self) -> Array:
        """The offsets (n,) of the opposite directions."""
        rows = 1 - self._direction
        is_known = self._is_known[rows, self._columns]
        chosen: Array = np.where(is_known, self._offsets[rows, self._columns], -self.offset)
        return chosen

    def _turn_round(self, is_turned: Mask, offset: Array) -> None:
        """The other direction, with these offsets (n,), for some of the joints."""
        self._direction = np.where(is_turned, 1 - self._direction, self._direction)
        self._offsets[self._direction, self._columns] = np.where(is_turned, offset, self.offset)
