"""What parallel platforms and serial arms share: poses, limits, motion and the nodes."""
