"""Progress of long work: bars on a terminal, plain lines elsewhere."""

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rich.console import Console

__all__ = ["Progress"]

_TENTHS = 10
_WIDE = 110
"""[columns] Narrowest terminal with room for a bar and the time left beside the text."""


class Progress:
    """Shows the progress of each stage on standard error: as a bar on a terminal; in a pipe or file as a line
    at its start, after each tenth and at its end. Silent with ``shown=False``."""

    def __init__(self, shown: bool = True) -> None:
        self.shown = shown

    @contextmanager
    def stage(self, label: str) -> Iterator["Stage"]:
        """Show the stage ``label`` until the block ends."""
        if not self.shown:
            yield Stage(label)
            return
        stage = _Bar(label) if sys.stderr.isatty() else _Lines(label)
        with stage.told():
            yield stage


class Stage:
    """One stage of `Progress`; this base class shows nothing."""

    def __init__(self, label: str) -> None:
        self.label = label

    def update(self, share: float, note: str = "") -> None:
        """Report that ``share`` (0 to 1) of the stage is done, with an optional short note."""


class _Lines(Stage):
    """A stage shown as lines; they depend on progress only, not on the clock."""

    def __init__(self, label: str) -> None:
        super().__init__(label)
        self._tenths = 0

    @contextmanager
    def told(self) -> Iterator[None]:
        self._say("")
        yield
        if self._tenths:
            self._say(": done")

    def update(self, share: float, note: str = "") -> None:
        tenths = min(int(_TENTHS * share + 1e-9), _TENTHS - 1)
        if tenths > self._tenths:
            self._tenths = tenths
            self._say(f": {tenths * 100 // _TENTHS} %{f', {note}' if note else ''}")

    def _say(self, more: str) -> None:
        print(f"{self.label}{more}", file=sys.stderr, flush=True)


class _Bar(Stage):
    """A stage with a bar on a terminal; text too long for one line continues on the next."""

    def __init__(self, label: str, console: "Console | None" = None) -> None:
        from rich.console import Console
        from rich.progress import BarColumn, SpinnerColumn, TextColumn, TimeElapsedColumn, TimeRemainingColumn
        from rich.progress import Progress as Bars
        from rich.table import Column

        super().__init__(label)
        console = console or Console(stderr=True)
        words = Column(no_wrap=False, overflow="fold")
        columns = [
            SpinnerColumn(finished_text="[green]✓"),
            TextColumn("{task.description}{task.fields[note]}", markup=False, table_column=words),
            TextColumn("{task.percentage:3.0f} %"),
            TimeElapsedColumn(),
        ]
        if console.width >= _WIDE:
            columns[2:3] = [BarColumn(bar_width=24)]
            columns += [TextColumn("left:"), TimeRemainingColumn()]
        self._bars = Bars(*columns, console=console)
        self._task = self._bars.add_task(label, total=None, note="")

    @contextmanager
    def told(self) -> Iterator[None]:
        with self._bars:
            yield
            self.update(1.0)

    def update(self, share: float, note: str = "") -> None:
        more = f": {note}" if note else ""
        self._bars.update(self._task, total=1.0, completed=min(share, 1.0), note=more)
