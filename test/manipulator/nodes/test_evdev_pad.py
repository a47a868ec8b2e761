import errno
import os
from dataclasses import dataclass, field, replace
from types import SimpleNamespace

import pytest

from manipulator.errors import LinkError
from manipulator.nodes.devices.evdev_pad import SYN, SYN_DROPPED, find_pad
from manipulator.teleop.pad import ABS, KEY

SOUTH, SELECT = 0x130, 0x13A


def span(low, high, value=0):
    return SimpleNamespace(min=low, max=high, value=value)


def event(kind, code, value):
    return SimpleNamespace(type=kind, code=code, value=value)


@dataclass
class FakeDevice:
    path: str
    name: str
    axes: dict = field(default_factory=dict)
    keys: list = field(default_factory=list)
    uniq: str = 'a0:b1'
    phys: str = 'usb-1'
    down: list = field(default_factory=list)
    events: list = field(default_factory=list)
    is_gone: bool = False
    is_closed: bool = False
    fd: int = field(default_factory=lambda: os.memfd_create('pad'))

    def capabilities(self):
        return {ABS: list(self.axes.items()), KEY: self.keys}

    def active_keys(self):
        return self.down

    def read(self):
        if self.is_gone:
            raise OSError(errno.ENODEV, os.strerror(errno.ENODEV))
        if not self.events:
            raise BlockingIOError
        events, self.events = self.events, []
        return iter(events)

    def opened_again(self):
        return replace(self, fd=os.open(f'/proc/self/fd/{self.fd}', os.O_RDONLY))

    def close(self):
        if not self.is_closed:
            os.close(self.fd)
        self.is_closed = True


@pytest.fixture
def machine():
    """A machine with a keyboard, a pad and the pad's motion sensors."""
    sticks = {0: span(0, 255, 128), 1: span(0, 255, 128)}
    return {
        'event0': FakeDevice('event0', 'Keyboard', keys=list(range(1, 99))),
        'event1': FakeDevice('event1', 'Wireless Controller', sticks, [SOUTH, SELECT]),
        'event2': FakeDevice(
            'event2', 'Wireless Controller Motion Sensors', {0: span(-9, 9), 1: span(-9, 9)}
        ),
    }


def found(machine):
    return find_pad(list(machine), machine.__getitem__)


def test_pad_is_found_with_its_sensors_and_other_devices_are_given_back(machine):
    pad = found(machine)
    assert (pad.path, pad.has_heartbeat) == ('event1', True)
    assert [device.is_closed for device in machine.values()] == [True, False, False]
    pad.close()
    assert all(device.is_closed for device in machine.values())


def test_sensors_of_another_pad_are_no_heartbeat(machine):
    machine['event2'].uniq = 'c2:d3'
    assert not found(machine).has_heartbeat
    assert machine['event2'].is_closed


def test_state_at_the_start_is_the_device_s_own(machine):
    machine['event1'].down = [SELECT]
    machine['event1'].axes[1] = span(0, 255, 0)
    axes, buttons = found(machine).update().joy
    assert axes[1] == 1.0
    assert buttons == [0, 1]


def test_wanted_pad_is_taken_with_its_sensors(machine):
    axes = machine['event1'].axes
    first = FakeDevice('event', 'Other', axes, [SOUTH], uniq='other')
    both = {'event': first} | machine
    pad = find_pad(list(both), both.__getitem__, 'event1')
    assert (pad.path, pad.has_heartbeat) == ('event1', True)
    with pytest.raises(LinkError, match='no gamepad found at event7 among 4'):
        find_pad(list(both), both.__getitem__, 'event7')


def test_events_change_the_state(machine):
    pad = found(machine)
    machine['event1'].events = [event(ABS, 0, 255), event(KEY, SOUTH, 1), event(SYN, 0, 0)]
    axes, buttons = pad.update().joy
    assert axes[0] == -1.0
    assert buttons == [1, 0]
    assert pad.update().joy == (axes, buttons)


def test_lost_events_are_made_good_from_the_device(machine):
    pad = found(machine)
    device = machine['event1']
    device.events = [event(KEY, SOUTH, 1)]
    assert pad.update().joy[1] == [1, 0]
    device.down, device.axes[0] = [], span(0, 255, 0)
    device.events = [event(SYN, SYN_DROPPED, 0)]
    axes, buttons = pad.update().joy
    assert axes[0] == 1.0
    assert buttons == [0, 0]


def test_heart_beats_only_when_the_sensors_report(machine):
    pad = found(machine)
    before = pad.update().joy[0][-1]
    assert pad.update().joy[0][-1] == before
    machine['event2'].events = [event(ABS, 0, 5), event(SYN, 0, 0)]
    assert pad.update().joy[0][-1] != before


@pytest.mark.parametrize('gone', ['event1', 'event2'])
def test_pad_that_has_gone_is_reported_by_name(machine, gone):
    pad = found(machine)
    machine[gone].is_gone = True
    with pytest.raises(LinkError, match='Wireless Controller was disconnected'):
        pad.update()


def test_no_input_devices_are_reported():
    with pytest.raises(LinkError, match='no input devices'):
        find_pad([], FakeDevice)


def test_no_gamepad_among_devices_is_reported_and_all_are_given_back(machine):
    del machine['event1']
    with pytest.raises(LinkError, match='no gamepad found among 2 input devices'):
        found(machine)
    assert all(device.is_closed for device in machine.values())


def test_missing_permission_names_the_group(machine):
    def refuse(path):
        if path == 'event1':
            raise PermissionError(errno.EACCES, 'Permission denied')
        return machine[path]

    with pytest.raises(LinkError, match=r'1 of 3 input devices may not be read.*group input'):
        find_pad(list(machine), refuse)


def test_pad_that_another_node_reads_is_not_taken_until_it_is_given_back(machine):
    again = {path: device.opened_again() for path, device in machine.items()}
    once_more = {path: device.opened_again() for path, device in machine.items()}
    first = found(machine)
    with pytest.raises(LinkError, match='Wireless Controller at event1 is in use by another'):
        found(again)
    assert all(device.is_closed for device in again.values())
    first.close()
    assert found(once_more).path == 'event1'


def test_second_node_takes_the_second_pad(machine):
    first = found(machine)
    other = replace(machine['event1'], path='event9', uniq='c2:d3', fd=os.memfd_create('other'))
    both = {'event1': machine['event1'].opened_again(), 'event9': other}
    assert (first.path, found(both).path) == ('event1', 'event9')
