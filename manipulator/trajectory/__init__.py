"""One file per profile or path: from a goal to a pose at every tick."""
