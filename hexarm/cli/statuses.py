"""Exit statuses of the `hexarm` command; 0 is good, 1 that something failed."""

REFUSED = 2
"""A refusal, or a question that was not understood."""

OUT_OF_REACH = 3
"""The answer no of `hexarm reach`: not the status of an error."""

PIPE_CLOSED = 141
"""The reader closed the output, as in `hexarm … | head`; by the shells' rule for SIGPIPE."""

INTERRUPTED = 130
"""Ctrl-C, by the shells' own rule."""
