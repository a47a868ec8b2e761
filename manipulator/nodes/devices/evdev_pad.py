"""Gamepads of a Linux machine: found among its input devices, and read through evdev."""

import contextlib
import fcntl
import glob
from collections.abc import Callable, Iterable, Sequence
from typing import Any, Protocol

from manipulator.errors import LinkError
from manipulator.teleop.pad import ABS, KEY, Axis, Pad, is_gamepad

SYN, SYN_REPORT, SYN_DROPPED = 0, 0, 3
"""The kind of event that ends a report, and the one that signals lost events."""


class Device(Protocol):
    """What is used of evdev.InputDevice."""

    fd: int
    path: str
    name: str
    uniq: str
    phys: str

    def capabilities(self) -> dict[int, list[Any]]:
        """Codes by kind of event; for axes (code, AbsInfo)."""
        ...

    def active_keys(self) -> list[int]:
        """The buttons that are down."""
        ...

    def read(self) -> Iterable[Any]:
        """Events that came; BlockingIOError when there are none, OSError when it has gone."""
        ...

    def close(self) -> None:
        """Gives the device back."""
        ...


class EvdevPad:
    """An open gamepad, with its motion sensors where it has some."""

    def __init__(self, device: Device, sensors: Device | None) -> None:
        self.name = device.name
        self.path = device.path
        self._device = device
        self._sensors = sensors
        self._pad = Pad.from_device(*_state(device), sensors is not None)

    def update(self) -> Pad:
        """The state after all events that came; LinkError once the pad has gone."""
        for event in self._events(self._device):
            if (event.type, event.code) == (SYN, SYN_DROPPED):
                self._pad = self._pad.resumed(*_state(self._device))
            else:
                self._pad = self._pad.after(event.type, event.code, event.value)
        if self._sensors is not None:
            for event in self._events(self._sensors):
                if (event.type, event.code) == (SYN, SYN_REPORT):
                    self._pad = self._pad.beaten()
        return self._pad

    @property
    def has_heartbeat(self) -> bool:
        """Whether a frozen pad can be distinguished from a steady thumb."""
        return self._sensors is not None

    def close(self) -> None:
        """Gives the devices back."""
        for device in (self._device, self._sensors):
            if device is not None:
                with contextlib.suppress(OSError):
                    device.close()

    def _events(self, device: Device) -> list[Any]:
        try:
            return list(device.read())
        except BlockingIOError:
            return []
        except OSError as error:
            raise LinkError(f'{self.name} was disconnected ({error.strerror})') from error


def input_devices() -> list[str]:
    """The paths of all input devices."""
    return sorted(glob.glob('/dev/input/event*'))


def find_pad(
    paths: Sequence[str], open_device: Callable[[str], Device], only: str = ''
) -> EvdevPad:
    """The first gamepad among paths that is free, or the one at the path `only`.

    A pad is free where no other process has claimed it here: so two machines, each with a gamepad
    node on the same computer, do not share one by accident. It is claimed until it is closed.
    LinkError with the reason where there is none.
    """
    devices: list[Device] = []
    denied = 0
    for path in paths:
        try:
            devices.append(open_device(path))
        except OSError:
            denied += 1
    pads = [d for d in devices if only in ('', d.path) and is_gamepad(*_state(d))]
    chosen = next((d for d in pads if _is_claimed(d)), None)
    if chosen is None:
        _close(devices)
        raise LinkError(_used(pads[0]) if pads else _why(len(paths), denied, only))
    sensors = next((d for d in devices if _is_sensor_of(chosen, d)), None)
    _close(d for d in devices if d not in (chosen, sensors))
    return EvdevPad(chosen, sensors)


def _is_claimed(device: Device) -> bool:
    """Claims the device, unless it is claimed already."""
    try:
        fcntl.flock(device.fd, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    return True


def _used(pad: Device) -> str:
    return (
        f'{pad.name} at {pad.path} is in use by another gamepad node; to drive two machines with '
        'one pad, give that node and each joy_teleop the same topic (-p topic:=/joy)'
    )


def _why(count: int, denied: int, only: str) -> str:
    none = f'no gamepad found{" at " if only else ""}{only}'
    if count == 0:
        return f'{none}: this machine has no input devices (/dev/input/event*)'
    if denied:
        return (
            f'{none}: {denied} of {count} input devices may not be read; '
            'add yourself to the group input (sudo usermod -aG input $USER) and log in again'
        )
    return f'{none} among {count} input devices: plug one in or pair it'


def _state(device: Device) -> tuple[dict[int, Axis], dict[int, bool]]:
    has = device.capabilities()
    down = set(device.active_keys())
    axes = {c: Axis(a.value, a.min, a.max) for c, a in has.get(ABS, []) if a.min < a.max}
    return axes, {code: code in down for code in has.get(KEY, [])}


def _is_sensor_of(pad: Device, device: Device) -> bool:
    """hid-playstation and hid-nintendo: the same unique id, and a matching name."""
    is_sensor = device.name.endswith(('Motion Sensors', 'IMU', '(IMU)'))
    return device is not pad and is_sensor and (device.uniq, device.phys) == (pad.uniq, pad.phys)


def _close(devices: Iterable[Device]) -> None:
    for device in devices:
        device.close()
