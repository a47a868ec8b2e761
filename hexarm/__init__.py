"""What a person starts: `hexarm`, the nodes, the page; and what a program imports: `Robot`.

Importing it sets what Fast DDS reads from the environment, unless the user has set it.
"""

import os
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from hexarm.robot import Robot
    from manipulator.errors import InvalidInput, ManipulatorError, Refused, Stopped, TimedOut
    from manipulator.pose import Pose

_HOMES = {
    'Robot': 'hexarm.robot',
    'Pose': 'manipulator.pose',
    'ManipulatorError': 'manipulator.errors',
    'InvalidInput': 'manipulator.errors',
    'Refused': 'manipulator.errors',
    'Stopped': 'manipulator.errors',
    'TimedOut': 'manipulator.errors',
}
"""Where the names of the Python client are: imported once they are used, since Robot needs ROS."""

__all__ = [
    'InvalidInput',
    'ManipulatorError',
    'Pose',
    'Refused',
    'Robot',
    'Stopped',
    'TimedOut',
]


def __getattr__(name: str) -> Any:
    """One of the names of the Python client."""
    if name not in _HOMES:
        raise AttributeError(f'module hexarm has no attribute {name!r}')
    return getattr(import_module(_HOMES[name]), name)


_PROFILES = 'FASTRTPS_DEFAULT_PROFILES_FILE'
_FOUND_HERE, _SKIP = 'DEFAULT_FASTRTPS_PROFILES.xml', 'SKIP_DEFAULT_XML_FILE'
_RANGE = 'ROS_AUTOMATIC_DISCOVERY_RANGE'
_DOMAINS = 100
_FAST_DDS = ('', 'rmw_fastrtps_cpp', 'rmw_fastrtps_dynamic_cpp')


def _profile(name: str) -> str:
    return str(Path(__file__).with_name(name))


def use_sockets() -> None:
    """Has Fast DDS use sockets alone, and announce processes every 0.2 s: docs/computers.md.

    Its shared memory is deleted under the others' feet when a killed process is started again:
    they find each other after 3 s, or never. With the discovery range LOCALHOST the ROS layer
    always adds shared memory. So this range is asked for in another way, which means the same:
    sockets of the loopback interface.
    """
    os.environ.setdefault('FASTDDS_BUILTIN_TRANSPORTS', 'UDPv4')
    is_local = os.environ.get(_RANGE) == 'LOCALHOST' and not os.environ.get('ROS_STATIC_PEERS')
    is_fast_dds = os.environ.get('RMW_IMPLEMENTATION', '') in _FAST_DDS
    ours = _profile('fastdds.xml'), _profile('fastdds_loopback.xml')
    own = os.environ.get(_PROFILES) not in (None, *ours)
    own = own or Path(_FOUND_HERE).exists()  # Fast DDS reads it after the other one
    if is_local and is_fast_dds and not own:
        os.environ[_PROFILES] = _profile('fastdds_loopback.xml')
        os.environ[_SKIP] = '1'  # nor may a process that is started elsewhere find one
        os.environ[_RANGE] = 'SUBNET'
    os.environ.setdefault(_PROFILES, _profile('fastdds.xml'))


def keep_to_this_computer() -> None:
    """No message leaves this computer; before ROS is initialised."""
    os.environ[_RANGE] = 'LOCALHOST'
    use_sockets()


def use_own_domain() -> None:
    """Keeps to this computer and to a ROS domain of this process, unless the user has chosen."""
    if _RANGE not in os.environ:
        keep_to_this_computer()
    os.environ.setdefault('ROS_DOMAIN_ID', str(1 + os.getpid() % _DOMAINS))


# Before numpy is imported: for 6×6 systems BLAS threads only cost, and on busy cores a call that
# waits for one of them can stall for a second.
os.environ.setdefault('OPENBLAS_NUM_THREADS', '1')
use_sockets()
