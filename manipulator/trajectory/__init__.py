"""Execution: who drives, which plan is active, and a pose for every tick."""
