"""What is measured, and against whom: `python -m bench` runs everything and prints one table."""

import sys
from pathlib import Path

import hexarm  # noqa: F401 (before numpy: one BLAS thread, as in every process of the graph)

sys.path.append(str(Path(__file__).parents[1] / 'test' / 'support'))  # the rig of whole graphs
