"""Parallel platforms as models whose parameters can be identified."""
