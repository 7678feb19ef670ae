"""The report of a playtest as plain values: read, written, and compared."""

import json
import os
from collections.abc import Mapping
from dataclasses import asdict, dataclass, fields
from pathlib import Path
from typing import Any

from runtime.errors import RuntimeInputError
from runtime.playtest.fault import KINDS, Fault, Sighting
from runtime.playtest.observation import Crossing, Journey
from surefoot.errors import SurefootError
from surefoot.files.atomic_write import whole_file
from surefoot.files.jsonfile import read_json
from surefoot.files.record_types import wrong_field

__all__ = ["FORMAT", "Chunks", "Report", "Setup", "fault_of", "read_report", "write_report"]

FORMAT = "surefoot playtest 2"


@dataclass(frozen=True)
class Setup:
    """What was asked for: enough to run any bot again."""

    level: str
    up: str | None
    scale: float | None
    plan: str | None
    body: str
    bots: int
    seconds: float
    seed: int


@dataclass(frozen=True)
class Chunks:
    """Of an open world how many chunks there are, and the names of those ``not_loaded``: no bot came so near
    that it would have them loaded."""

    count: int
    not_loaded: tuple[str, ...]


@dataclass(frozen=True)
class Report:
    """What a playtest found. Equal setups give equal reports.

    ``digest`` names the level's geometry; ``character`` who played; ``faults`` are faults and notes in the
    order of their numbers, which count from 1. ``coverage`` (k, 2): time [s] and share of the reachable
    floor that some bot has been to; ``patches`` (n, 4): place [m] and how many quarter seconds bots spent
    there.
    """

    setup: Setup
    digest: str
    character: Mapping[str, Any]
    faults: tuple[Fault, ...]
    crossings: tuple[Crossing, ...]
    journeys: tuple[Journey, ...]
    coverage: tuple[tuple[float, float], ...]
    patches: tuple[tuple[float, float, float, int], ...]
    reachable: float
    """[m²] of floor that players can reach."""
    chunks: Chunks | None = None
    """None where the level is no open world."""

    @property
    def held(self) -> bool:
        """Whether nothing fails the playtest."""
        return not any(fault.fails for fault in self.faults)

    @property
    def failures(self) -> tuple[Fault, ...]:
        """The faults without the notes."""
        return tuple(fault for fault in self.faults if fault.fails)

    def to_dict(self) -> dict[str, Any]:
        """The report as plain values, for JSON."""
        rest = {
            name: getattr(self, name) for name in ("digest", "character", "coverage", "patches", "reachable")
        }
        return {
            "format": FORMAT,
            "held": self.held,
            "setup": asdict(self.setup),
            "faults": [{"number": k, **fault.to_dict()} for k, fault in enumerate(self.faults, start=1)],
            "crossings": [asdict(each) for each in self.crossings],
            "journeys": [asdict(each) for each in self.journeys],
            **rest,
            **({} if self.chunks is None else {"chunks": asdict(self.chunks)}),
        }


def write_report(report: Report, path: str | os.PathLike[str]) -> None:
    """Write ``report`` as JSON, whole or not at all."""
    with whole_file(path) as temporary:
        temporary.write_text(json.dumps(report.to_dict(), indent=1) + "\n", encoding="utf-8")


def read_report(path: str | os.PathLike[str]) -> Report:
    """Read what `write_report` wrote. Raises `RuntimeInputError` for any other file."""
    file = Path(path)
    try:
        values = read_json(file, "report of a playtest")
    except SurefootError as error:
        raise RuntimeInputError(str(error)) from None
    if not isinstance(values, dict) or values.get("format") != FORMAT:
        raise RuntimeInputError(f"{file}: not a report of a playtest: expected format {FORMAT!r}")
    try:
        report = Report(
            setup=Setup(**values["setup"]),
            digest=values["digest"],
            character=values["character"],
            faults=tuple(fault_of(each) for each in values["faults"]),
            crossings=tuple(
                Crossing(**{**each, "position": tuple(each["position"])}) for each in values["crossings"]
            ),
            journeys=tuple(Journey(**each) for each in values["journeys"]),
            coverage=tuple((t, share) for t, share in values["coverage"]),
            patches=tuple((x, y, z, n) for x, y, z, n in values["patches"]),
            reachable=values["reachable"],
            chunks=_chunks_of(values.get("chunks")),
        )
        parts = (report, report.setup, *report.faults, *report.crossings, *report.journeys)
        if report.chunks is not None:
            parts = (*parts, report.chunks)
        for part in (*parts, *(seen for fault in report.faults for seen in fault.sightings)):
            if (field := wrong_field(part)) is not None:
                raise TypeError(f"{field} of a {type(part).__name__} is of a wrong type")
        if unknown := [fault.kind for fault in report.faults if fault.kind not in KINDS]:
            raise ValueError(f"a fault of the kind {unknown[0]!r}")
        return report
    except (KeyError, TypeError, ValueError) as error:
        raise RuntimeInputError(f"{file}: not a whole report of a playtest: {error}; run it again") from None


def _chunks_of(values: Any) -> Chunks | None:
    return None if values is None else Chunks(values["count"], tuple(values["not_loaded"]))


def fault_of(values: Mapping[str, Any]) -> Fault:
    """What `Fault.to_dict` made plain."""
    own = {field.name: values[field.name] for field in fields(Fault)}
    own["position"] = tuple(own["position"])
    own["span"] = tuple(tuple(end) for end in own["span"])
    sightings = (Sighting(each["bot"], each["time"], tuple(each["position"])) for each in own["sightings"])
    return Fault(**{**own, "sightings": tuple(sightings)})
