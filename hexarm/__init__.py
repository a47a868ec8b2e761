"""The `hexarm` command, one file per subcommand."""
