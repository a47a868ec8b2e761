"""Platforms on each other: their kinematics, limits and machine file."""
