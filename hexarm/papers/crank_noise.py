"""The accuracy experiment of Prokopovich 2019: 1° of noise on one, three and all six servos.

The paper adds noise behind the inverse kinematics while the platform does the sinusoids of fig.
12. It states neither the law of the noise nor whether it is one signal or six. Both are computed:
one signal on all servos, in the direction that each servo turns (even legs are mirrored, eq. 11),
and a signal of its own for each. Along the motion the noise is normal with σ = 1/6°, so that a
band of ±3σ is 1° wide: our choice, and the one free number.
"""

import itertools
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from hexarm import machines
from hexarm.cli.accuracy import common_error
from hexarm.papers.finding import ROTARY, Claim, Finding, unstated
from hexarm.simulation.limit_search import FREQUENCY, PAPER_AMPLITUDE, in_phase, poses_of
from manipulator.analysis.accuracy import JointErrors, drawn_spread, linear_spread
from manipulator.kinematics import Kinematics
from manipulator.planning.cycle import Cycle

MACHINE = 'robocake'
SIGMA = np.radians(1.0 / 6.0)
AS_UNIFORM = np.sqrt(3.0) * SIGMA
"""The bound of a uniform noise of the same variance: to first order only that matters."""
PAPER_UM = {1: 24.7, 3: 30.0, 6: 9.9}
NAMES = {1: 'one servo', 3: 'three servos', 6: 'all six servos'}
DRAWS = 1000
SAME, HALF = 0.25, 1.0
"""Parts of the paper's figure: our agreement, and the same order of magnitude."""
Chosen = tuple[int, ...]


def subsets(count: int) -> list[Chosen]:
    """Every choice of `count` of the six servos, from 0: the paper does not say which."""
    return list(itertools.combinations(range(6), count))


@dataclass(frozen=True)
class Laws:
    """The two readings of one noise of bound `size` (rad, uniform) on the servos of MACHINE."""

    size: float

    @cached_property
    def common(self) -> JointErrors:
        """One signal on all servos."""
        return common_error(machines.read(MACHINE), self.size, 6)

    @cached_property
    def independent(self) -> JointErrors:
        """A signal of its own for each servo, and no other error."""
        return JointErrors.of(6, noise=self.size)


def along_motion(kinematics: Kinematics, errors: JointErrors, cycle: Cycle) -> float:
    """Rms position error in metres over a period of the cycle, to first order."""
    spread = linear_spread(kinematics, poses_of(cycle), errors)
    return float(np.sqrt(np.mean(spread.position_rms**2)))


def findings() -> Iterator[Finding]:
    """Along the motion with both laws; what follows for the paper's conclusion; at home."""
    kinematics = machines.load(MACHINE).kinematics
    cycle = in_phase(kinematics.home, np.array(PAPER_AMPLITUDE), FREQUENCY)
    laws = Laws(AS_UNIFORM)
    for law, errors in (('common', laws.common), ('independent', laws.independent)):
        means = {}
        for count in PAPER_UM:
            rms = [1e6 * along_motion(kinematics, errors.on(s), cycle) for s in subsets(count)]
            means[count] = float(np.mean(rms))
            yield _row(law, count, rms)
        yield conclusion(law, means)
    yield from at_home(kinematics)


def conclusion(law: str, means: dict[int, float]) -> Finding:
    """Whether errors cancel: the paper's is less on six servos than on one."""
    reason = (
        'one signal turns the platform about z and shifts it to second order only: the paper’s '
        'conclusion is one of common noise'
        if law.endswith('common')
        else 'squares of independent errors add, so they do not cancel'
    )
    ratio = means[6] / means[1]
    return Finding(
        f'noise_{law}_cancels', ROTARY, f'{words(law)}: error of six servos by that of one',
        Claim('errors cancel (0.40)', (1.0,), side='at most'), f'{ratio:.2f}', (ratio,), '', 0.05,
        reason,
    )  # fmt: skip


def at_home(kinematics: Kinematics) -> Iterator[Finding]:
    """Both laws with a uniform ±1° at rest: no reading of the paper, for checks by others."""
    laws = Laws(float(np.radians(1.0)))
    for law, errors in (('common', laws.common), ('independent', laws.independent)):
        home = kinematics.home
        rms = [
            1e6 * float(linear_spread(kinematics, home, errors.on(s)).position_rms)
            for s in ((0,), (0, 1, 2), tuple(range(6)))
        ]
        spread = drawn_spread(kinematics, home, errors, DRAWS, np.random.default_rng(1))
        shown = ', '.join(f'{v:.1f}' for v in rms)
        yield Finding(
            f'noise_home_{law}', ROTARY,
            f'{words(law)}, uniform ±1°, at rest at home: servo 1, servos 1 to 3, all',
            unstated(), f'{shown} µm; all six, drawn: {1e6 * spread.position_rms:.2g} µm',
            tuple(rms), 'µm', 0.05, 'to first order; `hexarm accuracy robocake`',
        )  # fmt: skip


def _row(law: str, count: int, rms: list[float]) -> Finding:
    paper, mean = PAPER_UM[count], float(np.mean(rms))
    spread = f', of the choices {min(rms):.1f} … {max(rms):.1f}' if len(rms) > 1 else ''
    return Finding(
        f'noise_{law}_{count}', ROTARY, f'{words(law)} on {NAMES[count]}, motion of fig. 12',
        Claim(f'{paper} µm', (paper,), SAME * paper, HALF * paper),
        f'{mean:.1f} µm rms{spread}', (mean,), 'µm', 0.01,
        'σ = 1/6°; mean over all choices of servos',
    )  # fmt: skip


def words(law: str) -> str:
    """The law of a noise, as in 'moving_common', for the report."""
    text = 'one noise signal' if law.endswith('common') else 'independent noise'
    return f'{text} in the moving model' if law.startswith('moving') else text
