"""`hexarm calibrate`: the values of a machine file, corrected by measurements of the machine."""

import argparse

from hexarm.calibration import geometry, poses, servos

PARTS = (servos, poses, geometry)


def add_parser(commands: 'argparse._SubParsersAction[argparse.ArgumentParser]') -> None:
    """Declares the subcommand and its parts."""
    parser = commands.add_parser('calibrate')
    parts = parser.add_subparsers(metavar='PART', title='parts', required=True)
    for part in PARTS:
        part.add_parser(parts)
