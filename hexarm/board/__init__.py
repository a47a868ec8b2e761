"""The board's program for a machine: its header, its build, its stand-in."""
