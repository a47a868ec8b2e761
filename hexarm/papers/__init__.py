"""What the three papers report, computed again, and the report that says how they compare."""
