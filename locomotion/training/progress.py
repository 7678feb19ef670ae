"""Progress of training and the time left."""

import sys
import time
from dataclasses import dataclass

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


def show(p: Progress) -> None:
    """One line that is rewritten on a terminal; elsewhere one line per ten generations."""
    line = (
        f"{p.stage}: generation {p.generation}/{p.generations}  cost {p.cost:.2f}"
        f"  survives {100 * p.survival:.0f} %  {p.elapsed / 60:.1f} min done, {p.remaining / 60:.1f} min left"
    )
    if sys.stderr.isatty():
        print(
            "\r\x1b[2K" + line, end="\n" if p.generation == p.generations else "", file=sys.stderr, flush=True
        )
    elif p.generation % 10 == 0 or p.generation == p.generations:
        print(line, file=sys.stderr, flush=True)
