"""A small change of a source, at one place."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Mutation:
    """Bytes start to end of a module, which hold `before`, become `after`; `line` counts from 1.

    statement is the line on which the statement begins that holds the place.
    """

    start: int
    end: int
    before: str
    after: str
    line: int
    statement: int

    def applied(self, source: bytes) -> bytes:
        """The module with this change."""
        return source[: self.start] + self.after.encode() + source[self.end :]

    def texts(self, source: bytes) -> tuple[str, str]:
        """The line before and after, without indentation."""
        mutant = self.applied(source)
        begin = source.rfind(b'\n', 0, self.start) + 1
        ends = (source.find(b'\n', self.start), mutant.find(b'\n', self.start))
        lines = (text[begin:end] for text, end in zip((source, mutant), ends, strict=True))
        before, after = (line.decode().strip() for line in lines)
        return before, after
