"""All parts of the report, in its order; the report names each part that is missing, and why.

What some installations lack is imported part by part: a missing package costs its part alone.
"""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from hexarm.papers.finding import ARM, LINEAR, ROTARY, Finding, Missing, Table
from hexarm.papers.report import Report

if TYPE_CHECKING:
    from hexarm.simulation.experiment import Recording

POINTS, TURNED_POINTS = 400_000, 8000
FEW_POINTS, FEW_TURNED_POINTS = 20_000, 2000
OnStage = Callable[[str, float], None]


@dataclass
class Reproduction:
    """What was found so far: grows part by part, from one thread. recording is that of fig. 13.

    is_quick takes fewer samples, and leaves out the noise in the moving model.
    """

    is_quick: bool
    findings: list[Finding] = field(default_factory=list)
    missing: list[Missing] = field(default_factory=list)
    tables: list[Table] = field(default_factory=list)
    recording: 'Recording | None' = None

    @property
    def report(self) -> Report:
        """What is there."""
        return Report(tuple(self.findings), tuple(self.missing), tuple(self.tables))

    def take(self, found: Iterable[Finding | Missing]) -> None:
        """Adds findings, and what is missing."""
        for item in found:
            if isinstance(item, Finding):
                self.findings.append(item)
            else:
                self.missing.append(item)


def reproduced(is_quick: bool, on_stage: OnStage) -> Reproduction:
    """Every part; `on_stage` receives the name of each as it ends."""
    this = Reproduction(is_quick)
    for source, topic, part in PARTS:
        try:
            part(this)
        except ModuleNotFoundError as error:
            this.missing.append(Missing(source, topic, f'{error.name} is not installed'))
        on_stage(topic, 1.0)
    return this


def _kinematics(this: Reproduction) -> None:
    from hexarm.papers import crank_kinematics  # noqa: PLC0415 (see above; below, too)

    this.take(crank_kinematics.findings())


def _workspace(this: Reproduction) -> None:
    from hexarm.papers import crank_workspace  # noqa: PLC0415

    points = (FEW_POINTS, FEW_TURNED_POINTS) if this.is_quick else (POINTS, TURNED_POINTS)
    this.take(crank_workspace.findings(*points))


def _noise(this: Reproduction) -> None:
    from hexarm.papers import crank_noise  # noqa: PLC0415

    this.take(crank_noise.findings())


def _dynamics(this: Reproduction) -> None:
    from hexarm.papers import crank_dynamics  # noqa: PLC0415

    found = crank_dynamics.reproduced(with_noise=not this.is_quick)
    this.take(found.findings)
    this.recording = found.recording


def _limits(this: Reproduction) -> None:
    from hexarm.papers import crank_limits  # noqa: PLC0415

    this.take(crank_limits.findings())
    this.tables.append(crank_limits.table(crank_limits.Searches()))


def _linear(this: Reproduction) -> None:
    from hexarm.papers import linear_platforms  # noqa: PLC0415

    this.take(linear_platforms.findings())


def _plates(this: Reproduction) -> None:
    from hexarm.papers import plates  # noqa: PLC0415

    this.take(plates.findings())


def _arm(this: Reproduction) -> None:
    from hexarm.papers import arm_method, arm_modes  # noqa: PLC0415

    this.take(arm_method.findings())
    this.take(arm_modes.findings())


def _times(this: Reproduction) -> None:
    from hexarm.papers import arm_times  # noqa: PLC0415

    this.take(arm_times.findings())


PARTS: tuple[tuple[str, str, Callable[[Reproduction], None]], ...] = (
    (ROTARY, 'home, ranges, crank speeds', _kinematics),
    (ROTARY, 'workspace', _workspace),
    (ROTARY, 'noise of the servos', _noise),
    (ROTARY, 'moving model', _dynamics),
    (ROTARY, 'torque, speed and payload', _limits),
    (LINEAR, 'motion linear in the legs', _linear),
    (LINEAR, 'angles and thickness of the plates', _plates),
    (ARM, 'method and modes', _arm),
    (ARM, 'times on a controller', _times),
)


def contradictions(findings: Iterable[Finding]) -> Iterator[str]:
    """A line for each finding that contradicts its paper."""
    for finding in findings:
        if finding.verdict == 'contradicts':
            yield f'{finding.source}, {finding.topic}: {finding.claim.text}; ours {finding.ours}'
