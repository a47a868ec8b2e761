"""A board on a pty: its state machine, servos, line and faults, for tests and demonstrations."""
