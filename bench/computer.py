"""Where and when a table was measured: figures without that say little."""

import os
import platform
import subprocess
from datetime import date
from pathlib import Path

import numpy as np


def this_computer() -> dict[str, str]:
    """Date, processor, what else it did, versions."""
    load = ', '.join(f'{average:.1f}' for average in os.getloadavg())
    return {
        'date': date.today().isoformat(),
        'commit': commit(),
        'processor': f'{processor()}, {os.cpu_count()} cores',
        'load averages at the start': f'{load} (above 0.5, others were active: repeat it)',
        'system': f'{platform.system()} {platform.release()}',
        'threads of linear algebra': os.environ.get('OPENBLAS_NUM_THREADS', 'as many as cores'),
        'Python, numpy': f'{platform.python_version()}, {np.__version__}',
    }


def processor() -> str:
    try:
        lines = Path('/proc/cpuinfo').read_text().splitlines()
    except OSError:
        return platform.machine()
    names = (line.partition(':')[2].strip() for line in lines if line.startswith('model name'))
    return next(names, platform.machine())


def commit() -> str:
    """Of the source tree, `+` where it has been changed since."""
    command = ['git', '-C', str(Path(__file__).parent), 'describe', '--always', '--dirty=+']
    try:
        return subprocess.run(command, capture_output=True, text=True, check=True).stdout.strip()
    except (OSError, subprocess.CalledProcessError):
        return 'unknown'
