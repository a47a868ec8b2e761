"""The subcommands of the `hexarm` command, one file each."""
