"""One quantity of a paper beside ours, and the verdict that its numbers give."""

from dataclasses import dataclass
from typing import Literal

ROTARY = 'Prokopovich 2019'
LINEAR = 'Lapikov et al. 2014'
ARM = 'Fadeev and Loginov'
Side = Literal['equal', 'at most', 'at least']
Verdict = Literal['agrees', 'partly', 'contradicts', 'meets', 'misses', 'not stated']


@dataclass(frozen=True)
class Claim:
    """What a paper states of a quantity: in its words, and in numbers that ours are judged by.

    values are in the unit of our values, one for each of them; () where the paper gives none. Ours
    may be off by `agrees`, and by `partly` for that verdict, on the wrong side of the paper's. A
    requirement of the paper (a time that its controller needs) is met or missed.
    """

    text: str
    values: tuple[float, ...] = ()
    agrees: float = 0.0
    partly: float = 0.0
    side: Side = 'equal'
    is_requirement: bool = False

    def off(self, ours: tuple[float, ...]) -> float:
        """By how much the worst of our values is on the wrong side of the paper's."""
        return max(self._off(a, b) for a, b in zip(ours, self.values, strict=True))

    def verdict(self, ours: tuple[float, ...]) -> Verdict:
        """Of values in the paper's order; ValueError where their number differs."""
        if not self.values:
            return 'not stated'
        off = self.off(ours)
        if self.is_requirement:
            return 'meets' if off <= self.agrees else 'misses'
        if off <= self.agrees:
            return 'agrees'
        return 'partly' if off <= self.partly else 'contradicts'

    def rule(self, unit: str) -> str:
        """How the verdict is computed, for the report."""
        if not self.values:
            return ''
        space = f' {unit}' if unit else ''
        values = ', '.join(f'{_number(v)}' for v in self.values)
        bound = f'{values}{space}' if self.side == 'equal' else f'{self.side} {values}{space}'
        within = f' ± {_number(self.agrees)}' if self.agrees else ''
        partly = f'; partly ± {_number(self.partly)}' if self.partly > self.agrees else ''
        return bound + within + partly

    def _off(self, ours: float, paper: float) -> float:
        if self.side == 'equal':
            return abs(ours - paper)
        return max(0.0, ours - paper if self.side == 'at most' else paper - ours)


@dataclass(frozen=True)
class Finding:
    """What `source` claims of `topic`, and what we found: `ours` as shown, `values` to compare.

    A fresh run must give each of `values` again to within `tolerance`; both are in `unit`.
    """

    key: str
    source: str
    topic: str
    claim: Claim
    ours: str
    values: tuple[float, ...]
    unit: str
    tolerance: float
    reason: str

    @property
    def verdict(self) -> Verdict:
        """By the claim, from the values."""
        return self.claim.verdict(self.values)


@dataclass(frozen=True)
class Missing:
    """A part of the report that this installation cannot compute, and why."""

    source: str
    topic: str
    why: str


@dataclass(frozen=True)
class Table:
    """Rows of numbers under names with units; a fresh run gives each to within a relative part."""

    key: str
    title: str
    head: tuple[str, ...]
    rows: tuple[tuple[float, ...], ...]
    tolerance: float


def unstated(text: str = 'not given') -> Claim:
    """For what the paper gives no number."""
    return Claim(text)


def minus(text: str) -> str:
    """With the typographic minus sign."""
    return text.replace('-', '−')


def _number(value: float) -> str:
    return minus(f'{value:.6g}')
