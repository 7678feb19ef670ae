"""What is kept of the bots' runs: what a report says of them. Tracks and poses are not, but for the first of
each trouble; with ten thousand bots they would fill the memory."""

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

import navmesh
from runtime.playtest.bots import BotRun, Trouble, Visit
from runtime.playtest.coverage import Coverage
from runtime.playtest.fault import Sighting
from runtime.playtest.wording import triple

__all__ = ["Cluster", "Tally", "sighted"]

_NEAR = 2.0  # [m] troubles of one kind nearer to each other than this are one
_AT_ONCE = 4096  # moments of a track that are looked at together
_FAULT = {"fell": "fell", "stuck": "stuck", "lost": "stuck", "bumped": "never_cleared", "no way": "blocked",
          "trapped": "trap"}  # fmt: skip


@dataclass(frozen=True)
class Cluster:
    """Troubles around one place: the first as it was, and of all of them where and by whom they were met."""

    first: Trouble
    places: list[tuple[float, float, float]] = field(default_factory=list)
    sightings: list[Sighting] = field(default_factory=list)

    def add(self, bot: int, trouble: Trouble) -> None:
        self.places.append(trouble.place)
        self.sightings.append(_sighting(bot, trouble))


class Tally:
    """Add runs in the order of the bots' numbers. ``patches`` (n, 3) [m]: those of the floor that count for
    coverage; ``open_world``: what is played, with nothing loaded, None for any other level."""

    def __init__(self, patches: np.ndarray, open_world: navmesh.OpenWorld | None = None) -> None:
        self.coverage = Coverage(patches)
        self.loaded: set[str] = set()
        """Names of the open world's chunks that were so near to a bot that it had them loaded."""
        self._open_world = open_world
        self.seconds = 0.0
        """Of all bots together."""
        self.visits: list[Visit] = []
        self.attempts: dict[int, int] = {}
        """Of each obstacle."""
        self.cleared: dict[int, int] = {}
        self._clusters: dict[str, list[Cluster]] = {kind: [] for kind in _FAULT.values()}

    def add(self, run: BotRun) -> None:
        """Add a finished run."""
        self.coverage.add(run.track)
        if self._open_world is not None:
            for begin in range(0, len(run.track), _AT_ONCE):
                places = run.track[begin : begin + _AT_ONCE, 1:]
                near = self._open_world.next_changes(places, len(self._open_world.chunks))
                self.loaded.update(near)
        self.seconds += run.seconds
        self.visits += run.visits
        for each in run.passings:
            self.attempts[each.obstacle] = self.attempts.get(each.obstacle, 0) + 1
            self.cleared[each.obstacle] = self.cleared.get(each.obstacle, 0) + each.cleared
        for trouble in run.troubles:
            self._cluster(trouble).add(run.number, trouble)

    def _cluster(self, trouble: Trouble) -> Cluster:
        """The first whose first trouble is near; a new one if there is none."""
        clusters = self._clusters[_FAULT[trouble.kind]]
        where = np.array(trouble.place)
        near = (c for c in clusters if np.linalg.norm(np.subtract(c.first.place, where)) <= _NEAR)
        home = next(near, None)
        if home is None:
            home = Cluster(trouble)
            clusters.append(home)
        return home

    def clusters(self) -> Iterator[tuple[str, Cluster]]:
        """Kinds of `runtime.playtest.fault.KINDS`, each with the troubles around one place."""
        for kind, clusters in self._clusters.items():
            for cluster in clusters:
                yield kind, cluster

    def met(self, sighting: Sighting) -> Trouble | None:
        """The trouble that ``sighting`` tells of, with its track and poses, if it is the first around its
        place."""
        return next((c.first for _, c in self.clusters() if c.sightings[0] == sighting), None)


def sighted(run: BotRun, sighting: Sighting) -> Trouble | None:
    """The trouble of a bot's ``run`` that a sighting tells of."""
    return next((each for each in run.troubles if _sighting(run.number, each) == sighting), None)


def _sighting(bot: int, trouble: Trouble) -> Sighting:
    return Sighting(bot, round(trouble.time, 2), triple(trouble.place))
