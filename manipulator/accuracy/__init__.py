"""How far servo errors and tolerances put a platform off: docs/workspace.md, section 5."""
