"""How far a long answer is, on the error output: a bar where rich is installed, else lines."""

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

OnProgress = Callable[[str, float], None]


@contextmanager
def progress() -> Iterator[OnProgress]:
    """A function that receives each stage and the share of it (0 to 1) that is done."""
    try:
        from rich.console import Console  # noqa: PLC0415 (an extra: plain lines do as well)
        from rich.progress import Progress  # noqa: PLC0415
    except ModuleNotFoundError:
        yield Lines().report
        return
    if not sys.stderr.isatty():
        yield Lines().report
        return
    with Progress(console=Console(stderr=True), transient=True) as bars:
        tasks: dict[str, Any] = {}

        def report(stage: str, share: float) -> None:
            if stage not in tasks:
                tasks[stage] = bars.add_task(stage, total=1.0)
            bars.update(tasks[stage], completed=share)

        yield report


class Lines:
    """One line a stage, when it is done; on a terminal its share until then, in place."""

    def report(self, stage: str, share: float) -> None:
        """Prints how far the stage is."""
        if share >= 1.0:
            print(f'{stage}: done', file=sys.stderr)
        elif sys.stderr.isatty():
            print(f'{stage}: {share:.0%}', end='\r', file=sys.stderr, flush=True)
