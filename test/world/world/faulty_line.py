"""A line and a board that fail at random, from a seed (bridge/fake/faults.py)."""

from bridge.fake.board_faults import BoardFaults
from bridge.fake.faults import Faults
from world.board import STEP


class FaultyLine:
    """Stands between the cable and the board of a world; `faults` counts what has begun."""

    def __init__(self, world, seed, per_minute):
        self._world, self._seed, self._per_minute = world, seed, per_minute
        self.count = 0
        self._begin(0.0)
        down, _ = world.cable.links
        down.lead_to(world.board, self._hear)
        self._cable, world.board.cable = world.cable, self
        world.board.every(STEP, self._advance)

    def storm(self, seconds):
        """Faults begin for so long; waits until the last one is over."""
        self._seed += 1
        self._begin(self._per_minute)
        self._world.run(seconds)
        self._faults.calm()
        self._world.wait('calm', lambda: not self._faults.active)
        self.count += self._faults.counts.total()

    def inject(self, kind):
        """One fault, for its longest time."""
        self._faults.inject(kind)

    def send_to_host(self, output):
        """As the cable does, for the board."""
        self._cable.send_to_host(self._board.to_host(output, self._world.now))

    def _begin(self, per_minute):
        self._faults = Faults(self._seed, per_minute)
        board = self._world.board.machine.board
        self._board = BoardFaults(board, self._faults, self._replug)

    def _hear(self, received):
        self._world.board.on_bytes(self._board.to_board(received, self._world.now))

    def _advance(self):
        self._board.advance(self._world.now)
        self._hear(b'')  # what was held back
        self._world.board.stuck_channel = self._board.stuck_channel

    def _replug(self, is_in):
        if is_in:
            self._world.cable.plug()
        else:
            self._world.cable.pull()
