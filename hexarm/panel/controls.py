"""The controls of the page: buttons, the machine's state, and six sliders for the goal.

Sliders are the same on every page, each with the range that is reachable now: millimetres and
degrees on the page, metres and radians everywhere else. Moving a slider by hand requests the goal;
`follow` moves the sliders without a request.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from hexarm.panel.reachable import AXES, bounds, coordinates, pose_at
from hexarm.panel.view import View
from manipulator.arrays import Array
from manipulator.machine import Machine
from manipulator.pose import Pose
from manipulator.states import MachineState

UNITS = np.array([1e3] * 3 + [180.0 / np.pi] * 3)
NAMES = tuple(f'{axis} [{unit}]' for axis, unit in zip(AXES, ['mm'] * 3 + ['°'] * 3, strict=True))
STEP = 0.1


class GoalSliders:
    """The user's goal; `request` is called with the pose at every move of a slider by hand."""

    def __init__(self, gui: Any, machine: Machine, request: Callable[[Pose], None]) -> None:
        home = coordinates(machine.kinematics.home)
        limits = np.round(bounds(machine) * UNITS[:, None], 1)
        self._request = request
        self._low, self._high = limits[:, 0], limits[:, 1]
        self._centre = home
        self._sliders = [
            gui.add_slider(name, float(low), float(high), STEP, float(np.clip(value, low, high)))
            for name, low, high, value in zip(
                NAMES, self._low, self._high, np.round(home * UNITS, 1), strict=True
            )
        ]
        self._values = home
        self._reach = gui.add_markdown('')
        for k, slider in enumerate(self._sliders):
            slider.on_update(self._moved(k))

    @property
    def pose(self) -> Pose:
        """The pose that the sliders show."""
        return pose_at(self._values)

    def follow(self, pose: Pose) -> None:
        """Shows another pose without a request: the machine went there by other means."""
        values = coordinates(pose, self._centre)
        shown = np.clip(np.round(values * UNITS, 1), self._low, self._high)
        self._values = values
        for slider, value in zip(self._sliders, shown.tolist(), strict=True):
            if abs(slider.value - value) > STEP / 2:
                slider.value = value

    def show_reach(self, pose: Pose, ranges: Array, reason: str) -> None:
        """Marks on each slider how far it alone may go from `pose`; the reason where nowhere."""
        values = coordinates(pose, self._centre)[:, None]
        ends = np.clip((values + ranges) * UNITS[:, None], self._low[:, None], self._high[:, None])
        for slider, (low, high) in zip(self._sliders, ends.tolist(), strict=True):
            marks = () if reason else ((low, f'{low:.1f}'), (high, f'{high:.1f}'))
            slider._marks = slider_marks(marks)
        self._reach.content = f'⚠ {reason}' if reason else ''

    def _moved(self, axis: int) -> Callable[[Any], None]:
        def on_update(event: Any) -> None:
            if event.client_id is None:  # set by `follow`, not by a hand
                return
            values = self._values.copy()
            values[axis] = event.target.value / UNITS[axis]
            self._values = values
            self._request(pose_at(values))

        return on_update


def slider_marks(marks: tuple[tuple[float, str], ...]) -> tuple[Any, ...]:
    """Marks in the form that a slider which already exists takes them."""
    from viser._messages import GuiSliderMark  # noqa: PLC0415

    return tuple(GuiSliderMark(value=value, label=label) for value, label in marks)


RED, GREY = (218, 54, 51), (68, 76, 86)
STATE_COLOURS: dict[str, str] = {
    MachineState.ENABLED: '#40c08c',
    MachineState.ARMING: '#f5b041',
    MachineState.HOLDING: '#f5b041',
    MachineState.STOPPED: '#e74c3c',
    MachineState.FAULT: '#e74c3c',
}
DIM = '#8b949e'

STOP_AGAIN = 1.0
"""How often STOP is sent while it is held, Hz."""

IN_SIGHT = """
<style>
  [id="{0}"] {{ height: 2.8em !important; }}
  div:has(> [id="{0}"]) {{ position: sticky; top: 0; z-index: 20; }}
  .mantine-ScrollArea-content div:has([id="{0}"]) {{ overflow: clip !important; }}
</style>"""
"""Keeps a button at the top of the panel when what is below it is scrolled; a thumb finds it.

What hides its overflow would be what a button sticks to; what clips it is not."""


@dataclass(frozen=True)
class Requests:
    """What the buttons call; each returns at once, from any thread."""

    emergency_stop: Callable[[], None]
    clear_fault: Callable[[], None]
    enable: Callable[[bool], None]
    home: Callable[[], None]
    start_cycle: Callable[[], None]
    pause: Callable[[bool], None]
    brake: Callable[[], None]
    set_speed: Callable[[float], None]
    choose_mode: Callable[[str], None]
    grip: Callable[[float], None]


class Buttons:
    """State line, STOP, servos, motion and speed."""

    def __init__(self, gui: Any, requests: Requests) -> None:
        self._requests = requests
        self._line = gui.add_html(state_line(View(), ''))
        stop = gui.add_button('STOP', color=RED, icon='hand-stop')

        async def on_stop(event: Any) -> None:
            requests.emergency_stop()

        # Coroutines run in the server's own loop: they wait for no thread.
        stop.on_hold(on_stop, callback_hz=STOP_AGAIN)  # sent on press …
        stop.on_click(on_stop)  # … and by the keyboard
        gui.add_html(IN_SIGHT.format(stop._impl.uuid))
        self._group(gui, 'Servos', {
            'Enable': lambda: requests.enable(True),
            'Disable': lambda: requests.enable(False),
            'Clear fault': requests.clear_fault,
        })  # fmt: skip
        self._group(gui, 'Motion', {
            'Home': requests.home,
            'Cycle': requests.start_cycle,
            'Brake': requests.brake,
        })  # fmt: skip
        self._group(gui, 'Pause', {
            'Pause': lambda: requests.pause(True),
            'Go on': lambda: requests.pause(False),
        })  # fmt: skip
        self._speed = gui.add_slider('speed [%]', 0, 100, 1, 100)
        self._speed.on_update(self._on_speed)

    def show(self, view: View, notice: str) -> None:
        """The machine's state, and the last answer to a button."""
        line = state_line(view, notice)
        if self._line.content != line:
            self._line.content = line

    def show_speed(self, share: float) -> None:
        """The override that is set."""
        percent = round(100 * share)
        if self._speed.value != percent:
            self._speed.value = percent

    def _on_speed(self, event: Any) -> None:
        if event.client_id is not None:
            self._requests.set_speed(event.target.value / 100)

    @staticmethod
    def _group(gui: Any, label: str, actions: dict[str, Callable[[], None]]) -> None:
        group = gui.add_button_group(label, tuple(actions))

        async def on_press(event: Any) -> None:
            actions[event.target.value]()

        group.on_click(on_press)


def state_line(view: View, notice: str) -> str:
    """The state in colour, the motion beside it, reasons below; as HTML."""
    colour = STATE_COLOURS.get(view.machine_state, DIM)
    motion = f' · {_escaped(view.motion or view.mode)}' if view.mode else ''
    lines = [
        f'<b style="color:{colour}">{_escaped(view.machine_state)}</b>'
        f'<span style="color:{DIM}">{motion}</span>'
    ]
    lines += [f'<span>{_escaped(text)}</span>' for text in (view.machine_reason, notice) if text]
    inner = '<br>'.join(lines)
    return f'<div id="state" style="padding:2px 12px 8px;font-size:13px">{inner}</div>'


def _escaped(text: str) -> str:
    return text.replace('&', '&amp;').replace('<', '&lt;')[:400]
