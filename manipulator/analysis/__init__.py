"""What a machine can reach, how exactly, and which machine it is: without time."""
