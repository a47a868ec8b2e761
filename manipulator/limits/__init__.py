"""One file per limit, and `Constraints`, the one check that everything uses."""
