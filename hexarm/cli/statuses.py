"""Exit statuses of the `hexarm` command; 0 is good, 1 that something failed."""

REFUSED = 2
"""A refusal, or a question that was not understood."""

OUT_OF_REACH = 3
"""The answer no of `hexarm reach`: a script tells it from a question that was not understood."""

PIPE_CLOSED = 141
"""Whoever read the output has gone, as in `hexarm … | head`; by the shells' rule for SIGPIPE."""

INTERRUPTED = 130
"""Ctrl-C, by the shells' own rule."""
