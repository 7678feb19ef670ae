"""What the bots met, gathered: troubles in clusters, obstacles that nobody cleared, journeys against plan."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import shapely

from runtime.playtest.bots import Visit
from runtime.playtest.fault import Fault
from runtime.playtest.holes import Hole
from runtime.playtest.site import Site
from runtime.playtest.tally import Tally
from runtime.playtest.wording import place, triple

__all__ = ["Crossing", "Journey", "crossings", "journeys", "observed", "with_sightings"]

_STOREY = 2.0  # [m] above or below a hole's rim that a fall into it ends
_CLAIMED = 2.5  # [m] a trouble this near to what the analysis found is a sighting of it
_BESIDE = 1.0  # [m] from a hole that a body falls into it
_CHANCE = 2  # sightings below which a trouble may be chance: a note
_TRIES = 2  # attempts at an obstacle after which never having cleared it counts
_SLOW, _START = 2.0, 1.0  # times the planned time, and as many seconds to turn and to set off
_MET = {
    "fell": ("falls", "fall"),
    "stuck": ("makes no headway", "make no headway"),
    "never_cleared": ("hits the level in the middle of a leap", "hit the level in the middle of a leap"),
    "blocked": (
        "stands where it does not fit and finds no way on",
        "stand where they do not fit and find no way on",
    ),
    "trap": ("gets in and finds no way out", "get in and find no way out"),
}
"""What one bot does, and what several do."""


@dataclass(frozen=True)
class Crossing:
    """How an obstacle fared: its name, affordance, height [m], place, attempts, and how many cleared it."""

    tag: str
    affordance: str
    height: float
    position: tuple[float, float, float]
    attempts: int
    cleared: int


@dataclass(frozen=True)
class Journey:
    """A way from a spawn to a place: how often tried and arrived, planned and median time [s] (0: never)."""

    start: str
    goal: str
    attempts: int
    arrived: int
    planned: float
    seconds: float


def crossings(site: Site, tally: Tally, obstacles: Sequence[int]) -> list[Crossing]:
    """What bots made of each of ``obstacles`` (indices)."""
    found = site.graph.obstacles
    sizes = found.size
    return [
        Crossing(str(found.tag[index]), str(found.affordance[index]), round(float(sizes[index]), 3),
                 triple(found.position[index]), tally.attempts.get(index, 0), tally.cleared.get(index, 0))
        for index in obstacles
    ]  # fmt: skip


def journeys(visits: Sequence[Visit]) -> list[Journey]:
    """The travellers' ways, by start and goal."""
    ways: dict[tuple[str, str], list[Visit]] = {}
    for each in visits:
        ways.setdefault((each.start, each.goal), []).append(each)
    table = []
    for (start, goal), mine in sorted(ways.items()):
        times = [each.seconds for each in mine if each.arrived]
        seconds = float(np.median(times)) if times else 0.0
        planned = float(np.median([each.planned for each in mine]))
        table.append(Journey(start, goal, len(mine), len(times), round(planned, 2), round(seconds, 2)))
    return table


def observed(site: Site, tally: Tally, ways: Sequence[Crossing], trips: Sequence[Journey]) -> list[Fault]:
    """The faults that bots met."""
    noun = site.character.noun
    faults = []
    for kind, cluster in tally.clusters():
        middle = np.median(cluster.places, axis=0)
        sightings = tuple(cluster.sightings)
        bots, times = len({each.bot for each in sightings}), len(sightings)
        who, often = f"{bots} bot{'s' * (bots > 1)}", f"{times} time{'s' * (times > 1)}"
        text = f"at {place(middle)} {who} {_MET[kind][bots > 1]} ({often})"
        if kind == "fell":
            text += f": the {noun} leaves the level or loses its feet here"
        fails = times >= _CHANCE or kind == "fell"
        faults.append(Fault(kind, triple(middle), text, fails, "bots", sightings=sightings))
    for each in ways:
        if each.attempts >= _TRIES and each.cleared == 0:
            text = (
                f"the {each.affordance} {each.tag!r} of {each.height:.2f} m at {place(each.position)} was "
                f"tried {each.attempts} times and never cleared"
            )
            faults.append(Fault("never_cleared", each.position, text, True, "bots"))
    for trip in trips:
        if trip.arrived and trip.seconds > _SLOW * trip.planned + _START:
            took = f"bots take {trip.seconds:.1f} s; planned are {trip.planned:.1f} s"
            text = f"from {trip.start} to {trip.goal} {took}"
            faults.append(Fault("slow", (0.0, 0.0, 0.0), text, False, "bots"))
    return faults


def with_sightings(analysed: Sequence[Fault], met: Sequence[Fault], holes: Sequence[Hole]) -> list[Fault]:
    """All findings, those of the bots as sightings of what the analysis has found at the same place: falls
    beside one of ``holes`` are of it, however large it is."""
    known = list(analysed)
    for fault in met:
        at = next(
            (k for k, each in enumerate(known) if each.found_by == "analysis" and _same(each, fault, holes)),
            None,
        )
        if at is None:
            known.append(fault)
        else:
            known[at] = replace(known[at], sightings=(*known[at].sightings, *fault.sightings))
    return known


def _same(analysed: Fault, met: Fault, holes: Sequence[Hole]) -> bool:
    if analysed.kind in ("hole", "open_edge"):
        at = shapely.points(met.position[:2])
        return met.kind == "fell" and any(
            analysed.position == triple(hole.place)
            and shapely.dwithin(hole.outline, at, _BESIDE)
            and hole.rim[:, 2].min() - _STOREY <= met.position[2] <= hole.rim[:, 2].max() + _STOREY
            for hole in holes
        )
    reach = _CLAIMED + (analysed.extent / np.pi) ** 0.5
    near = np.linalg.norm(np.subtract(analysed.position, met.position)) <= reach
    return bool(near) and analysed.kind in ("trap", "one_way") and met.kind in ("trap", "blocked", "stuck")
