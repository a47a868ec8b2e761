"""What is measured, and against whom: `python -m bench` runs everything and prints one table."""

import hexarm  # noqa: F401 (before numpy: one BLAS thread, as in every process of the graph)
