"""Serial arms as models whose parameters can be identified."""
