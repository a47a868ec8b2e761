"""What limits share that speak of another limit: its names."""

from dataclasses import dataclass

from manipulator.limits.limit import Limit


@dataclass(frozen=True, eq=False)
class LimitOf:
    """A limit with the quantity, unit and owners of `inner`."""

    inner: Limit

    @property
    def quantity(self) -> str:
        """That of the limit."""
        return self.inner.quantity

    @property
    def unit(self) -> str:
        """That of the limit."""
        return self.inner.unit

    @property
    def owners(self) -> tuple[str, ...]:
        """Those of the limit."""
        return self.inner.owners
