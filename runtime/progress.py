"""What a user sees while something takes long: nothing at all when the output is not a terminal."""

import sys
from collections.abc import Iterator
from contextlib import contextmanager

__all__ = ["Progress"]


class Progress:
    """Bars on the standard error output, one for each stage; made quiet with ``shown=False``."""

    def __init__(self, shown: bool | None = None) -> None:
        self.shown = sys.stderr.isatty() if shown is None else shown

    @contextmanager
    def stage(self, label: str) -> Iterator["Stage"]:
        """Show ``label`` with the time that it takes until the block ends."""
        if not self.shown:
            yield Stage(None, label)
            return
        from rich.console import Console
        from rich.progress import BarColumn, SpinnerColumn, TextColumn, TimeElapsedColumn, TimeRemainingColumn
        from rich.progress import Progress as Bars

        columns = (
            SpinnerColumn(finished_text="[green]✓"),
            TextColumn("{task.description}"),
            BarColumn(bar_width=24),
            TextColumn("{task.fields[note]}"),
            TimeElapsedColumn(),
            TextColumn("left:"),
            TimeRemainingColumn(),
        )
        with Bars(*columns, console=Console(stderr=True)) as bars:
            stage = Stage(bars, label)
            yield stage
            stage.done()


class Stage:
    """One stage of `Progress`."""

    def __init__(self, bars, label: str) -> None:
        self._bars = bars
        self._task = bars.add_task(label, total=None, note="") if bars is not None else None

    def update(self, share: float, note: str = "") -> None:
        """Say that ``share`` (0…1) of the stage is done, and a few words more."""
        if self._bars is not None:
            self._bars.update(self._task, total=1.0, completed=min(share, 1.0), note=note)

    def done(self) -> None:
        """The stage is at its end."""
        if self._bars is not None:
            self._bars.update(self._task, total=1.0, completed=1.0)
