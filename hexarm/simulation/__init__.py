"""Rigid bodies and drives: what the machines weigh, and what they do when pushed."""
