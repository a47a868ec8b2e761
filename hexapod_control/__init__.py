"""Parallel platforms: geometry, inverse and forward kinematics, workspace."""
