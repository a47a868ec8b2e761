"""`fake_hardware` with the program on a simulated chip: the board of `hexarm up --port simavr`."""

import sys
from functools import partial

from bridge.fake.fake_hardware_node import FakeHardware
from firmware.simulator.board import SimulatedBoard
from hexarm.board.plant import fake_machine
from hexarm.machines import board_config, described
from manipulator.nodes.run import run_nodes


def main() -> int:
    """Runs the node."""
    make = partial(fake_machine, make_board=SimulatedBoard)
    return run_nodes([lambda: FakeHardware(board_config, make)], described)


if __name__ == '__main__':
    sys.exit(main())
