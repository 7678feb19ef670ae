"""The findings of several seeds put together: steady ones, that every seed shows, and flaky ones."""

from collections.abc import Sequence
from dataclasses import dataclass

from runtime.playtest.diff import same_finding
from runtime.playtest.fault import Fault
from runtime.playtest.report import Report

__all__ = ["Finding", "changed", "findings_of"]


@dataclass(frozen=True)
class Finding:
    """One finding of a ``level`` with a ``body``: the ``fault`` as the first seed that has it says it, and
    the ``seeds`` that have it, of ``tried``. A fault that only some have is *flaky*: it depends on chance, or
    on where bots happened to go."""

    level: str
    body: str
    fault: Fault
    seeds: tuple[int, ...]
    tried: int

    @property
    def flaky(self) -> bool:
        """Whether some seeds do not have it."""
        return len(self.seeds) < self.tried

    @property
    def text(self) -> str:
        """Where, with whom, and what."""
        return f"{self.level}, {self.body}: {self.fault.title}: {self.fault.text}"

    def is_same(self, other: "Finding") -> bool:
        """Whether it is one finding, on two nights."""
        return (self.level, self.body) == (other.level, other.body) and same_finding(self.fault, other.fault)


def findings_of(level: str, body: str, reports: Sequence[Report]) -> list[Finding]:
    """The findings of ``reports`` of one level and body, one for each seed; in the order of the first report,
    then what the others add. Each finding of a report counts once."""
    first: list[Fault] = []
    seeds: list[list[int]] = []
    for report in reports:
        taken: set[int] = set()
        for fault in report.faults:
            alike = (k for k, each in enumerate(first) if k not in taken and same_finding(each, fault))
            k = next(alike, len(first))
            if k == len(first):
                first.append(fault)
                seeds.append([])
            taken.add(k)
            seeds[k].append(report.setup.seed)
    pairs = zip(first, seeds, strict=True)
    return [Finding(level, body, fault, tuple(seen), len(reports)) for fault, seen in pairs]


def changed(
    before: Sequence[Finding], after: Sequence[Finding]
) -> tuple[tuple[Finding, ...], tuple[Finding, ...]]:
    """Findings of ``after`` that ``before`` did not have, and those of ``before`` that are gone."""
    left, new = list(before), []
    for finding in after:
        twin = next((each for each in left if each.is_same(finding)), None)
        if twin is None:
            new.append(finding)
        else:
            left.remove(twin)
    return tuple(new), tuple(left)
