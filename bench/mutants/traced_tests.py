"""A pytest plugin: which places of the C libraries each test runs.

The libraries write them (coverage.c) into files of $C_COVERAGE; `places.json` in a folder of each
worker says at the end which test was where: {library: {test: [offset, …]}}.
"""

import json
import os
from collections import defaultdict
from pathlib import Path

import numpy as np
import pytest

LIBRARIES = ('kernel', 'board')
BYTES = 1 << 22
FOLDER = Path(os.environ['C_COVERAGE_RUN']) / os.environ.get('PYTEST_XDIST_WORKER', 'main')

FOLDER.mkdir(parents=True, exist_ok=True)
os.environ['C_COVERAGE'] = str(FOLDER)
MAPS = {
    name: np.memmap(FOLDER / name, dtype=np.uint8, mode='w+', shape=BYTES) for name in LIBRARIES
}
PLACES: dict[str, dict[str, list[int]]] = {name: defaultdict(list) for name in LIBRARIES}


@pytest.hookimpl(trylast=True)
def pytest_runtest_logfinish(nodeid):
    """What was run since the test before is this one's."""
    for name, seen in MAPS.items():
        places = np.flatnonzero(seen)
        seen[places] = 0
        PLACES[name][nodeid] = places.tolist()


def pytest_sessionfinish():
    (FOLDER / 'places.json').write_text(json.dumps(PLACES))
