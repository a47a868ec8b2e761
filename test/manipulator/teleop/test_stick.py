import pytest
from hypothesis import given
from hypothesis import strategies as st

from manipulator.errors import ConfigError
from manipulator.teleop.gamepad import Stick

values = st.floats(-1.05, 1.05)
sticks = st.builds(
    Stick,
    moves=st.just('x'),
    axis=st.just(0),
    full_speed=st.floats(0.01, 1.0),
    sign=st.sampled_from([1, -1]),
    rest=st.sampled_from([0.0, 1.0, -1.0]),
    deadzone=st.floats(0.01, 0.9),
    expo=st.floats(0.0, 1.0),
)


@given(sticks, values)
def test_speed_never_exceeds_full_speed_and_has_the_way_of_the_axis(stick, value):
    speed = stick.speed(value)
    assert abs(speed) <= stick.full_speed * (1 + 1e-12)
    assert speed * stick.sign * (value - stick.rest) >= 0


@given(sticks, values, values)
def test_more_deflection_is_never_slower(stick, a, b):
    near, far = sorted((stick.deflection(a), stick.deflection(b)))
    speeds = {stick.deflection(v): stick.speed(v) for v in (a, b)}
    assert speeds[near] <= speeds[far] + 1e-12


@given(sticks)
def test_speed_begins_at_zero_where_the_deadzone_ends(stick):
    edge = stick.rest - stick.deadzone * (1 + abs(stick.rest)) * (1 if stick.rest > 0 else -1)
    just_outside = edge + (1e-9 if stick.rest <= 0 else -1e-9)
    assert stick.speed(edge + (edge - stick.rest) * -1e-6) == 0.0
    assert abs(stick.speed(just_outside)) < 1e-6 * stick.full_speed


@given(sticks)
def test_full_deflection_gives_full_speed(stick):
    end = -1.0 if stick.rest > 0 else 1.0
    assert abs(stick.speed(end)) == pytest.approx(stick.full_speed)


def test_expo_makes_half_deflection_finer_without_changing_the_end():
    straight, bent = (Stick('x', 0, 0.1, deadzone=0.0, expo=e) for e in (0.0, 1.0))
    assert straight.speed(0.5) == pytest.approx(0.05)
    assert bent.speed(0.5) == pytest.approx(0.0125)


def test_trigger_moves_one_way_from_its_rest_at_plus_one():
    lift = Stick('z', 5, 0.1, sign=-1, rest=1.0)
    assert lift.speed(1.0) == 0.0
    assert lift.speed(-1.0) == pytest.approx(0.1)


def test_trigger_without_deadzone_is_refused():
    with pytest.raises(ConfigError, match='deadzone'):
        Stick('z', 5, 0.1, rest=1.0, deadzone=0.0)
