"""The `hexarm` command, one file per subcommand."""

import os
from pathlib import Path

# Before numpy is imported: for 6×6 systems BLAS threads only cost, and on busy cores a call that
# waits for one of them can stall for a second.
os.environ.setdefault('OPENBLAS_NUM_THREADS', '1')
# Fast DDS: sockets alone. Processes that are killed leave its shared memory behind, and it is no
# quicker for messages of this size.
os.environ.setdefault('FASTDDS_BUILTIN_TRANSPORTS', 'UDPv4')
# And soon found: the file says why.
os.environ.setdefault(
    'FASTRTPS_DEFAULT_PROFILES_FILE', str(Path(__file__).with_name('fastdds.xml'))
)
