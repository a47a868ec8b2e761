from types import SimpleNamespace

import pytest

from bridge.events import Disconnected, StateReceived, without_passed_states
from bridge.protocol import Mode


def reported(*modes):
    """STATEs of these modes, numbered; None is an event of another kind."""
    return [
        Disconnected('why')
        if mode is None
        else StateReceived(SimpleNamespace(mode=mode, number=i))
        for i, mode in enumerate(modes)
    ]


@pytest.mark.parametrize(
    ('modes', 'kept'),
    [
        ((), []),
        ((Mode.ARMED,), [0]),
        ((Mode.ARMED, Mode.ARMED, Mode.HOLDING, Mode.HOLDING), [1, 3]),
        ((Mode.DISARMED, Mode.DISARMED), [1]),
        ((Mode.ARMED, Mode.DISARMED, Mode.ARMED), [0, 1, 2]),
        ((Mode.ARMED, None, Mode.ARMED), [0, 1, 2]),
    ],
)
def test_the_last_state_of_each_mode_is_reported_in_order(modes, kept):
    events = reported(*modes)
    assert without_passed_states(events) == [events[i] for i in kept]
