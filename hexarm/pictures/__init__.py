"""Pictures of what the commands compute."""
