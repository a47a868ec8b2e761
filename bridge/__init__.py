"""From joint commands to frames on a serial line, and back."""
