"""The pytest plugin: playtests in a game's own test suite.

```python
def test_the_courtyard_can_be_played(playtest):
    played = playtest("levels/courtyard.obj", bots=16, seconds=60)
    played.has_no_faults()
    played.covers(0.8)
    played.clears("lane 1")
    played.arrives(within=1.5)
```

A test that fails leaves the report's page in pytest's folder for it and says where.
"""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

__all__ = ["Played", "playtest"]


class Played:
    """What a playtest found, with assertions; ``report`` is the whole `runtime.playtest.Report`.

    Every assertion returns the object, so that they can be chained.
    """

    def __init__(self, outcome: Any, folder: Path) -> None:
        self.report = outcome.report
        self._outcome = outcome
        self._folder = folder

    def has_no_faults(self, *kinds: str) -> "Played":
        """Nothing fails; with ``kinds`` (see `runtime.playtest.fault.KINDS`), nothing of these."""
        from runtime.playtest.fault import KINDS

        unknown = [kind for kind in kinds if kind not in KINDS]
        if unknown:
            raise ValueError(f"unknown kind {unknown[0]!r}; valid: {', '.join(KINDS)}")
        faults = [fault for fault in self.report.failures if not kinds or fault.kind in kinds]
        self._hold(not faults, "\n".join(f"{fault.title}: {fault.text}" for fault in faults))
        return self

    def covers(self, share: float) -> "Played":
        """Bots have been to at least ``share`` (0 to 1) of the floor that can be reached."""
        found = self.report.coverage[-1][1]
        self._hold(found >= share, f"bots covered {found:.1%} of the reachable floor, not {share:.1%}")
        return self

    def clears(self, *tags: str) -> "Played":
        """Every obstacle, or those with these tags, was cleared at least once."""
        known = {each.tag: each for each in self.report.crossings}
        missing = [tag for tag in tags if tag not in known]
        self._hold(
            not missing, f"no bot can reach an obstacle {', '.join(missing)}; there are: {', '.join(known)}"
        )
        never = [each for each in known.values() if each.cleared == 0 and (not tags or each.tag in tags)]
        self._hold(
            not never,
            "\n".join(f"{each.tag} was tried {each.attempts} times and never cleared" for each in never),
        )
        return self

    def arrives(self, within: float = 2.0) -> "Played":
        """Every journey from a spawn to a place arrives, in ``within`` times the planned time at the
        median."""
        slow = [
            f"{each.start} to {each.goal}: {each.arrived} of {each.attempts} arrived, "
            f"{each.seconds:.1f} s of {each.planned:.1f} s planned"
            for each in self.report.journeys
            if each.arrived < each.attempts or each.seconds > within * each.planned + 1.0
        ]
        self._hold(not slow, "\n".join(slow))
        return self

    def _hold(self, holds: bool, message: str) -> None:
        __tracebackhide__ = True
        if holds:
            return
        from runtime.playtest.page import write_page
        from runtime.playtest.report import write_report

        write_report(self.report, self._folder / "report.json")
        write_page(self._outcome, self._folder / "report.html")
        pytest.fail(f"{message}\nreport: {self._folder / 'report.html'}", pytrace=False)


@pytest.fixture
def playtest(tmp_path: Path) -> Callable[..., Played]:
    """A function that playtests a level and returns a `Played`; arguments as of
    `runtime.playtest.playtest`."""

    def play(level: str | Path, **options: Any) -> Played:
        from runtime.playtest import playtest as run

        return Played(run(level, **options), tmp_path)

    return play
