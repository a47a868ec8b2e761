"""Plans: motions that are computed, timed and checked before anything moves."""
