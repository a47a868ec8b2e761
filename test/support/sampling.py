"""How much is tried: as much as finds the faults; with THOROUGH=1 in the environment, more."""

import os

IS_THOROUGH = os.environ.get('THOROUGH') == '1'


def enough(usual, thorough):
    """What to try of all that could be tried: a number, or a list."""
    return thorough if IS_THOROUGH else usual


def some(items, count):
    """`count` of the items, spread over them evenly from the first on."""
    found = list(items)
    return found if IS_THOROUGH else found[:: max(1, len(found) // count)][:count]
