"""What tests of every folder may ask for, and what keeps those of several workers apart."""

import gc
import importlib.util
import os
import random
import shutil
from pathlib import Path

import pytest
from hypothesis import HealthCheck, settings

import hexarm
from hexarm.board import build as firmware_build
from sampling import IS_THOROUGH, enough

# How long a computer takes is no verdict. A run tries the same as the last one, but for thorough
# runs, which look for what no run has tried yet.
settings.register_profile(
    'patient',
    deadline=None,
    max_examples=enough(40, 200),
    derandomize=not IS_THOROUGH,
    suppress_health_check=[HealthCheck.too_slow],
)
settings.load_profile('patient')

CHROMIUM = shutil.which('chromium') or '/usr/bin/chromium'
QUIET = ('background-networking', 'component-update', 'sync', 'default-apps', 'extensions')
FLAGS = [
    '--no-sandbox',
    '--use-angle=swiftshader',
    '--enable-unsafe-swiftshader',
    '--no-first-run',
    *(f'--disable-{name}' for name in QUIET),
]

FOLDER = Path(__file__).parent
LONGEST = ('firmware', 'graph', 'install')
STARTS_OTHERS = {'browser', 'sit_down'}
DOMAINS = range(1, 101)

RUN = os.environ.get('PYTEST_XDIST_TESTRUNUID', str(os.getpid()))
WORKER = int(os.environ.get('PYTEST_XDIST_WORKER', 'gw0').removeprefix('gw'))
os.environ['ROS_DOMAIN_ID'] = str(random.Random(RUN).sample(DOMAINS, len(DOMAINS))[WORKER])
# Not by the variable alone: with it the ROS layer adds shared memory to this process, and then a
# process that was killed and started again is sometimes never joined (docs/computers.md).
hexarm.keep_to_this_computer()


@pytest.fixture(scope='session', autouse=True)
def users_data(tmp_path_factory):
    """Saved poses of shipped machines are in a folder of this test run, not in the user's."""
    os.environ['XDG_DATA_HOME'] = str(tmp_path_factory.mktemp('data'))


def pytest_collection_modifyitems(items):
    """Marks what starts other programs (graphs, installations, a browser), and what is long.

    The chip is simulated instruction by instruction: the same tests and the same C run on the
    computer's board in no time.
    """
    for item in items:
        folder = item.path.relative_to(FOLDER).parts[0]
        if folder in ('graph', 'install') or STARTS_OTHERS & set(item.fixturenames):
            item.add_marker('processes')
        elif 'chip_tools' in item.fixturenames:
            item.add_marker('long')
    # First what takes longest: the rest fills up the workers at the end.
    items.sort(key=lambda item: item.path.relative_to(FOLDER).parts[0] not in LONGEST)


def pytest_collection_finish():
    """What is there by now stays: every garbage collection of every test would search it again."""
    gc.freeze()


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config, log):
    """`--dist loadfile` keeps folders together as well, where their files share a graph."""
    from xdist.scheduler import LoadFileScheduling  # noqa: PLC0415 (there where this is called)

    class Scheduling(LoadFileScheduling):
        def _split_scope(self, nodeid):
            return shared_place(Path(super()._split_scope(nodeid)))

    config.option.loadscopereorder = False  # not by the number of tests, but as collected
    return Scheduling(config, log) if config.getvalue('dist') == 'loadfile' else None


def shared_place(file):
    """The file, or its folder where that is one of test/graph, or test/install."""
    folder = file.parent
    return str(folder if 'graph' in folder.parts[:-1] or folder.name == 'install' else file)


@pytest.fixture(scope='session')
def worker():
    """The number of this worker among those that run tests at the same time, from 0."""
    return WORKER


@pytest.fixture(scope='session')
def chip_tools():
    """The board's compiler and its simulated chip; skips without, if anything may be."""
    missing = firmware_build.missing_tools()
    if missing and os.environ.get('REQUIRE_ALL') != '1':
        pytest.skip(f'not installed: {", ".join(missing)}')


@pytest.fixture(scope='module')
def browser():
    """Chromium; where it cannot be had, the tests are skipped, or fail where all must run."""
    found = [name for name in ('playwright', 'viser') if importlib.util.find_spec(name) is None]
    missing = found or [path for path in (CHROMIUM,) if not os.path.exists(path)]
    if missing and os.environ.get('REQUIRE_ALL') != '1':
        pytest.skip(f'not installed: {", ".join(missing)}')
    from playwright.sync_api import sync_playwright  # noqa: PLC0415 (an error only if required)

    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=FLAGS, timeout=180_000)
        yield browser
        browser.close()
