"""Which machine it truly is: its parameters from poses that a measuring device saw."""
