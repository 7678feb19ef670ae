"""Progress of training and the time left."""

import atexit
import time
from contextlib import ExitStack
from dataclasses import dataclass

from surefoot.progress import Progress as Shown
from surefoot.progress import Stage

__all__ = ["Clock", "Progress", "show"]


@dataclass(frozen=True)
class Progress:
    """Progress of training: shown on a terminal, or passed to the caller's function."""

    stage: str
    generation: int
    generations: int
    cost: float
    survival: float
    elapsed: float
    remaining: float


class Clock:
    """Estimates the time left of all searches of a skill from the duration of the trials so far. ``ahead``:
    approximate simulated time to come [s]."""

    def __init__(self, ahead: float) -> None:
        self.ahead = ahead
        self._begun, self._done = time.monotonic(), 0.0

    def skip(self, simulated: float) -> None:
        """Count [s] simulated by an earlier process."""
        self.ahead -= simulated

    def advance(self, simulated: float) -> tuple[float, float]:
        """Count [s] simulated now; returns the elapsed time and the time left [s]."""
        self.ahead, self._done = max(self.ahead - simulated, 0.0), self._done + simulated
        elapsed = time.monotonic() - self._begun
        return elapsed, elapsed / self._done * self.ahead


class _Shown:
    """Shows training on standard error, one stage after the other, as all long work is shown
    (`surefoot.progress`)."""

    def __init__(self) -> None:
        self._open, self._name = ExitStack(), ""
        self._stage = Stage("")
        atexit.register(self._open.close)  # a bar that is left open hides the terminal's cursor

    def __call__(self, p: Progress) -> None:
        if p.stage != self._name:
            self._open.close()
            self._name, self._stage = p.stage, self._open.enter_context(Shown().stage(p.stage))
        self._stage.update(
            p.generation / p.generations,
            f"generation {p.generation}/{p.generations}, cost {p.cost:.2f}, "
            f"survives {100 * p.survival:.0f} %, "
            f"{p.elapsed / 60:.1f} min done, {p.remaining / 60:.1f} min left",
        )
        if p.generation == p.generations:
            self._open.close()
            self._name = ""


show = _Shown()
"""What trainings do with their progress unless they are told otherwise."""
