"""Sleeps that libfaketime leaves alone, for a process whose clock it shifts.

From Python 3.11 on time.sleep waits until a time of the monotonic clock; libfaketime 0.9.10
shifts that time as one of the other clock, and each sleep is refused. select waits for a length.
"""

import select
import time


def sleep(seconds):
    select.select((), (), (), seconds)


time.sleep = sleep
