"""Exit statuses of the `hexarm` command, one table for all subcommands (docs/cli.md)."""

FAILED = 1
"""Something failed: no machine, a node that ended, a disk that is full."""

REFUSED = 2
"""A refusal, or a question that was not understood."""

OUT_OF_REACH = 3
"""A pose that the machine cannot reach: the answer no of `reach`, `ik` and `go`."""

PIPE_CLOSED = 141
"""The reader closed the output, as in `hexarm … | head`; by the shells' rule for SIGPIPE."""

INTERRUPTED = 130
"""Ctrl-C, by the shells' own rule."""

STATUSES = f'Exit status: 0 good, {REFUSED} not understood, {OUT_OF_REACH} out of reach.'
"""The end of the help of commands that take a pose."""
