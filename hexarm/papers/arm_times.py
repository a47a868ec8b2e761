"""What a step of Fadeev and Loginov costs on a controller: in C, on the simulated ATmega2560."""

from collections.abc import Iterator

from hexarm.board import build as firmware_build
from hexarm.papers.finding import ARM, Claim, Finding, Missing, unstated

CHIP = 'ATmega2560 at 16 MHz'
REASON = 'single precision, on a simulated chip, exact to the clock cycle'
SAME, ROUGHLY = 0.25, 1.0
"""Parts by which two amounts of computation may differ to be alike, or roughly so."""
SINES = 12


def findings() -> Iterator[Finding | Missing]:
    """Times of one step, of one sine, of the other two ways; or why there are none."""
    missing = firmware_build.missing_tools()
    if missing:
        yield Missing(ARM, 'times on a controller', f'not there: {", ".join(missing)}')
        return
    try:
        times = firmware_build.step_times()
    except firmware_build.CannotBuild as error:
        yield Missing(ARM, 'times on a controller', str(error).splitlines()[0])
        return
    yield from requirements(times)
    yield from ways(times)


def requirements(times: dict[str, float]) -> Iterator[Finding]:
    """The paper's two controllers, one by one."""
    step, sine = times['step_time'], times['sine_time']
    rest = step - SINES * sine
    rows = (
        ('step_c167', 'one step of the method', '< 20 ms on a C167', 20.0, step, 'ms',
         f'{SINES * sine:.2f} ms for {SINES} sines, {rest:.2f} ms for the rest (paper: 12 and 8)'),
        ('step_mf167', 'the same', '≤ 1 ms with the MF167 coprocessor', 1.0, step, 'ms',
         'an 8-bit controller without a coprocessor'),
        ('sine_c167', 'one sine', '< 2 ms on a C167', 2.0, sine, 'ms', REASON),
        ('sine_mf167', 'the same', '0.7 µs with the MF167', 0.7e-3, sine, 'ms',
         'an 8-bit controller without a coprocessor'),
    )  # fmt: skip
    for key, topic, text, limit, time, unit, reason in rows:
        claim = Claim(text, (limit,), side='at most', is_requirement=True)
        shown = f'{time:.2f} ms on an {CHIP}'
        yield Finding(key, ARM, topic, claim, shown, (time,), unit, 0.02 * time, reason)


def ways(times: dict[str, float]) -> Iterator[Finding]:
    """The closed forms beside the step."""
    step, geometric = times['step_time'], times['geometric_time']
    algebraic = times['algebraic_time']
    ratio = geometric / step
    yield Finding(
        'time_geometric', ARM, 'time by triangles (second way), by that of a step (third way)',
        Claim('about as much computation', (1.0,), SAME, ROUGHLY),
        f'{ratio:.2f} ({geometric:.2f} and {step:.2f} ms)', (ratio,), '', 0.02, REASON,
    )  # fmt: skip
    yield Finding(
        'time_algebraic', ARM, 'time by the forward equations (first way)',
        unstated('very laborious'), f'{algebraic:.2f} ms', (algebraic,), 'ms', 0.02 * algebraic,
        'laborious to derive only: once sines and cosines are the unknowns, it is the cheapest, '
        'and within 1 ms on this controller',
    )  # fmt: skip
