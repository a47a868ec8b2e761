"""Namespaces on the command line, and the message for one without a machine."""

import argparse
import re
from collections.abc import Collection

from manipulator.errors import TimedOut
from manipulator.formatting import shown

NAMESPACE = re.compile(r'/?[A-Za-z_]\w*(/[A-Za-z_]\w*)*/?', re.ASCII)


MARK = '/machine_state'
"""The topic by which a machine's namespace is known."""


class NoMachine(TimedOut):
    """No machine answers in a namespace."""


def no_machine_in(namespace: str, there: Collection[str], domain: int) -> str:
    """That no machine is in a namespace, and where others are; `there` are published topics."""
    others = sorted(topic.removesuffix(MARK) for topic in there if topic.endswith(MARK))
    hint = f' There are machines in {", ".join(others)}' if others else ''
    space = namespace.strip('/')
    return f'no machine found in /{space} on ROS domain {domain}: is it running there?{hint}'


def namespace_of(name: str) -> str:
    """Without slashes at its ends; an argument error for what ROS would not accept."""
    if NAMESPACE.fullmatch(name) is None:
        raise argparse.ArgumentTypeError(
            f'{shown(name)} is not a ROS name: letters, digits, _ and /'
        )
    return name.strip('/')
