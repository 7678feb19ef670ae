"""Bots: what each wants, and its run from its first step to its last.

A bot's run depends on the level, the plan, the seed and its own number, and on no other bot. Its number also
says what it is: every fifth explores for coverage, travels between spawns and places, tries every obstacle,
roams: goes straight on like a player who tries the level's edges; or probes: pushes at one piece of the
floor's edges after the other.

Probers share the edges without a word between them: each begins at a place of its own, the golden ratio of
all of them farther than the one before, and takes every `_SKIPPED`th piece first. So all edges are soon
tried, and holes are found several times as fast as by roaming (`python -m benchmarks.playtest_search`).
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from navmesh.routes.route import LinkUse, Route
from runtime.playtest.movers import Leg, Mover, mover_of
from runtime.playtest.site import Site

__all__ = ["ROLES", "BotRun", "Goals", "Passing", "Trouble", "Visit", "run_bot"]

ROLES = ("explorer", "traveller", "trier", "roamer", "prober")
_ROAMING = 12.0  # [s] of a stretch of roaming
_STEP_BACK = 3  # times that a bot finds no way before it gives up and appears anew
_MARGIN = 3.0  # times the planned time, and as many seconds, after which a leg is given up
_FEWEST = 64  # headings drawn for a stretch of roaming
_PUSHING, _SKIPPED = 0.3, 4  # [s] of pushing at a piece of edge; pieces to the next one
_GOLDEN = 0.5 * (math.sqrt(5.0) - 1.0)


@dataclass(frozen=True)
class Goals:
    """Where bots go. ``spawns`` (s, 3) and ``places`` (p, 3) [m] with their names; ``targets`` (t, 3) [m]:
    one for each patch of floor that can be reached; ``obstacles``: those that can be reached and cleared;
    ``edges`` (e, 3) [m] and ``outward`` (e,) [rad]: as of `runtime.playtest.floor_edges`."""

    spawn_names: tuple[str, ...]
    spawns: np.ndarray
    place_names: tuple[str, ...]
    places: np.ndarray
    targets: np.ndarray
    obstacles: tuple[int, ...]
    edges: np.ndarray
    outward: np.ndarray


@dataclass(frozen=True)
class Trouble:
    """What went wrong: ``kind`` of `Leg.status` or "trapped", when [s], where [m], over which obstacle
    (-1: none), and the last seconds: the track (n, 4) and `Mover.poses`."""

    kind: str
    time: float
    place: tuple[float, float, float]
    obstacle: int
    track: np.ndarray
    poses: np.ndarray | None


@dataclass(frozen=True)
class Visit:
    """A journey from a spawn to a place: names, seconds planned and taken, whether it arrived."""

    start: str
    goal: str
    planned: float
    seconds: float
    arrived: bool


@dataclass(frozen=True)
class Passing:
    """An attempt at an obstacle, and whether it was cleared."""

    obstacle: int
    cleared: bool


@dataclass
class BotRun:
    """What a bot did. ``track`` (n, 4) float64: time [s] and place [m], all of its run."""

    number: int
    role: str
    seconds: float = 0.0
    tracks: list[np.ndarray] = field(default_factory=list)
    troubles: list[Trouble] = field(default_factory=list)
    visits: list[Visit] = field(default_factory=list)
    passings: list[Passing] = field(default_factory=list)

    @property
    def track(self) -> np.ndarray:
        return np.concatenate(self.tracks) if self.tracks else np.empty((0, 4))


def run_bot(
    site: Site, goals: Goals, seed: int, number: int, seconds: float, mover: Mover | None = None
) -> BotRun:
    """The run of bot ``number`` for ``seconds`` [s] of its time."""
    bot = _Bot(site, goals, seed, number, seconds, mover or mover_of(site))
    while bot.run.seconds < seconds - 1e-9:
        bot.act()
    return bot.run


class _Bot:
    def __init__(
        self, site: Site, goals: Goals, seed: int, number: int, seconds: float, mover: Mover
    ) -> None:
        self.site, self.goals, self.seconds = site, goals, seconds
        self.mover = mover
        self.rng = np.random.default_rng([seed, number])
        self.run = BotRun(number, ROLES[number % len(ROLES)])
        self.lost = 0
        self.spawn = 0
        self.wants = {"explorer": self._explore, "traveller": self._journeys, "trier": self._try,
                      "roamer": self._roam, "prober": self._probe}[self.run.role]()  # fmt: skip
        self._appear()

    def act(self) -> None:
        """Do the next thing."""
        before = self.run.seconds
        next(self.wants)
        if self.run.seconds <= before:  # nothing to do here takes time too, or a run would never end
            self.run.seconds += 1.0

    @property
    def left(self) -> float:
        return self.seconds - self.run.seconds

    def _appear(self, spawn: int | None = None) -> None:
        self.spawn = int(self.rng.integers(len(self.goals.spawns))) if spawn is None else spawn
        self.mover.appear(self.goals.spawns[self.spawn], float(self.rng.uniform(-math.pi, math.pi)))
        self.lost = 0

    def _route(self, goal: np.ndarray) -> Route:
        character = self.site.character
        return self.site.graph.find_path(
            self.mover.place, goal, radius=character.radius, skills=dict(character.skills)
        )

    def _go(self, route: Route) -> Leg:
        """Follow a complete route; trouble on the way is noted, and after it the bot appears anew."""
        limit = min(self.left, _MARGIN * (route.length / self.site.character.speed + 1.0))
        leg = self.mover.travel(route, limit)
        self._note(leg)
        for use in route.links:
            passed = leg.status == "arrived" or use.obstacle != leg.obstacle
            if leg.status == "arrived" or use.obstacle == leg.obstacle:
                self.run.passings.append(Passing(use.obstacle, passed))
        return leg

    def _note(self, leg: Leg) -> None:
        track = leg.track.copy()
        track[:, 0] += self.run.seconds
        self.run.tracks.append(track)
        self.run.seconds += leg.seconds
        if leg.status == "arrived" or (leg.status == "out of time" and self.left <= 1e-9):
            return
        kind = "stuck" if leg.status == "out of time" else leg.status
        self._trouble(kind, leg.place, leg.obstacle)
        self._appear()

    def _trouble(self, kind: str, place: np.ndarray, obstacle: int = -1) -> None:
        recent = self.run.track[-24:]
        where = (float(place[0]), float(place[1]), float(place[2]))
        self.run.troubles.append(Trouble(kind, self.run.seconds, where, obstacle, recent, self.mover.poses))

    def _reach(self, goal: np.ndarray) -> Leg | None:
        """Go to a place that can be reached from a spawn; None when there is no way from here."""
        route = self._route(goal)
        if route.status == "complete":
            self.lost = 0
            return self._go(route) if route.length > 0.0 else None
        self.lost += 1
        if self.lost >= _STEP_BACK:
            kind = "no way" if route.status == "off_graph" else "trapped"
            self._trouble(kind, self.mover.place)
            self._appear()
        return None

    def _explore(self) -> Iterator[None]:
        """To the patches of floor that it has not been to, in an order of its own."""
        seen = np.zeros(len(self.goals.targets), dtype=bool)
        while True:
            order = self.rng.permutation(np.flatnonzero(~seen))
            if not len(order):
                seen[:] = False
                continue
            # the nearest of a few: less walking over known floor, and no two bots alike
            few = order[:8]
            target = few[np.argmin(np.linalg.norm(self.goals.targets[few] - self.mover.place, axis=1))]
            seen[target] = True
            leg = self._reach(self.goals.targets[target])
            if leg is not None and len(leg.track):
                near = np.linalg.norm(self.goals.targets[:, None] - leg.track[None, ::4, 1:], axis=2)
                seen |= (near < 1.5).any(axis=1)
            yield

    def _journeys(self) -> Iterator[None]:
        """From spawns to places, every pair in turn."""
        pairs = [(s, p) for s in range(len(self.goals.spawns)) for p in range(len(self.goals.places))]
        while True:
            for k in self.rng.permutation(len(pairs)) if pairs else ():
                start, goal = pairs[k]
                self._appear(start)
                leg = self._reach(self.goals.places[goal])
                if leg is not None and leg.status != "out of time":
                    names = self.goals.spawn_names[start], self.goals.place_names[goal]
                    self.run.visits.append(Visit(*names, leg.planned, leg.seconds, leg.status == "arrived"))
                yield
            if not pairs:
                yield

    def _try(self) -> Iterator[None]:
        """Over every obstacle, at one of its links."""
        site, links = self.site, self.site.graph.links
        while True:
            for obstacle in self.rng.permutation(np.array(self.goals.obstacles, dtype=np.int64)).tolist():
                own = site.ways[links.obstacle[site.ways] == obstacle]
                link = int(own[self.rng.integers(len(own))])
                before = self._reach(links.start[link])
                if before is None or before.status == "arrived":
                    self._go(_over(site, link, self.mover.place))
                yield
            if not self.goals.obstacles:
                yield

    def _roam(self) -> Iterator[None]:
        """Straight on, off ledges and into corners; now and then to somewhere else."""
        while True:
            headings = self.rng.uniform(-math.pi, math.pi, _FEWEST)
            self._note(self.mover.wander(headings, min(self.left, _ROAMING)))
            yield
            if self.left > 0.0:
                self._reach(self.goals.targets[int(self.rng.integers(len(self.goals.targets)))])
                yield

    def _probe(self) -> Iterator[None]:
        """Along the edges of the floor, pushing at them."""
        edges = self.goals.edges
        count = len(edges)
        share = (self.run.number // len(ROLES)) * _GOLDEN % 1.0
        order = [range(first, count, _SKIPPED) for first in range(_SKIPPED)]
        while True:
            for k in (piece for some in order for piece in some):
                at = (k + int(count * share)) % count
                leg = self._reach(edges[at])
                if self.left > 0.0 and (leg is None or leg.status == "arrived"):
                    others = self.rng.uniform(-math.pi, math.pi, _FEWEST - 1)
                    headings = np.concatenate([self.goals.outward[at : at + 1], others])
                    self._note(self.mover.wander(headings, min(self.left, _PUSHING)))
                yield
            if not count:
                yield


def _over(site: Site, link: int, here: np.ndarray) -> Route:
    """The route over one link from its run-up point, where the body stands."""
    links = site.graph.links
    points = np.array([here, links.start[link], links.end[link]])
    length = float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum())
    nodes = site.graph.label[[links.start_cell[link], links.end_cell[link]]]
    uses = [LinkUse(link, int(links.obstacle[link]), 1, 2)]
    return Route("complete", site.character.radius, nodes, points, length, uses, 0, site.graph)
