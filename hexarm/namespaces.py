"""Names of namespaces on the command line."""

import argparse
import re

NAMESPACE = re.compile(r'/?[A-Za-z_]\w*(/[A-Za-z_]\w*)*/?', re.ASCII)


def namespace_of(word: str) -> str:
    """Without slashes at its ends; an argument error for what ROS would not accept."""
    if NAMESPACE.fullmatch(word) is None:
        raise argparse.ArgumentTypeError(f'{word!r} is no ROS name: letters, digits, _ and /')
    return word.strip('/')
