"""How much a machine reaches: volumes, sections, surfaces, and what it is like inside."""
