"""Subcommands for machines that run: start, move, stop, watch, record."""
