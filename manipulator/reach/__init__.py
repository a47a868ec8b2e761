"""What a machine can reach, which limits are in the way, and how near it can come."""
