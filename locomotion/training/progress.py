"""How far learning has come, and how long it will still take."""

import sys
import time
from dataclasses import dataclass

__all__ = ["Clock", "Progress", "show"]


@dataclass(frozen=True)
class Progress:
    """Where learning stands: shown on a terminal, or given to the caller's function."""

    stage: str
    generation: int
    generations: int
    cost: float
    survival: float
    elapsed: float
    remaining: float


class Clock:
    """Tells the time left of all the searches by which a skill is learned from how long the trials so far
    took. ``ahead``: what will be simulated [s], about."""

    def __init__(self, ahead: float) -> None:
        self.ahead = ahead
        self._begun, self._done = time.monotonic(), 0.0

    def skip(self, simulated: float) -> None:
        """So much [s] was simulated before."""
        self.ahead -= simulated

    def advance(self, simulated: float) -> tuple[float, float]:
        """So much [s] was simulated now: the time since the beginning and the time left [s]."""
        self.ahead, self._done = max(self.ahead - simulated, 0.0), self._done + simulated
        elapsed = time.monotonic() - self._begun
        return elapsed, elapsed / self._done * self.ahead


def show(p: Progress) -> None:
    """One line that is rewritten on a terminal; elsewhere a line per ten generations."""
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
