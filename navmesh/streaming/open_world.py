"""A world of which only what is near the players is loaded, and routes through all of it."""

import hashlib
import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import inf, isfinite
from numbers import Integral, Real
from pathlib import Path
from typing import Any

import numpy as np

from navmesh.errors import NavmeshError, NoFloorError
from navmesh.graph.node_graph import NodeGraph
from navmesh.graph.open_to_body import checked_radius, checked_skills
from navmesh.level.chunks import join_chunks
from navmesh.level.terrain import Terrain
from navmesh.streaming.choosing import HOLD, distances, in_order, nearness
from navmesh.streaming.coarse_graph import ANCHOR, AROUND
from navmesh.streaming.coarse_search import parts_reached, shortest_chain
from navmesh.streaming.world_folder import Body, read_chunk, read_index
from navmesh.streaming.world_route import WorldRoute

__all__ = ["OpenWorld"]

_NEARER = 0.01  # [m] by which a place must be nearer to a goal than the start, to be worth going to
_CLOSE = 1.0  # [m] up to which a coarse waypoint counts as passed
_ALONG = 64  # places on the way to a coarse waypoint that is not loaded, from which what is loaded is known;
_TRIED = 16  # so many of those that are loaded are gone to, if one can


@dataclass(frozen=True, slots=True, eq=False)
class _Window:
    """What is loaded. Replaced as one, so that a route that is asked for meanwhile sees one state."""

    graph: NodeGraph | None
    loaded: np.ndarray  # (c,) bool


class OpenWorld:
    """An open world that `navmesh.bake_open_world` has written to ``folder``.

    `keep_around` loads the chunks that are at most ``radius`` [m] away from a player, seen from above, and
    drops those that are more than ``drop_beyond`` [m] away from all, by default 1.2 times as far. `graph` is
    the fine graph of what is loaded; `route` leads through all of the world. Takes load time: reads one file,
    of about 10 MB for each km² and body radius. Raises `NavmeshError` for a folder without a world,
    `ArchiveError` for a damaged one.
    """

    def __init__(
        self, folder: str | os.PathLike[str], radius: float = 250.0, drop_beyond: float | None = None
    ) -> None:
        self._radius = _length("radius", radius)
        self._drop_beyond = 1.2 * self._radius if drop_beyond is None else _length("drop_beyond", drop_beyond)
        if self._drop_beyond < self._radius:
            raise NavmeshError(
                f"drop_beyond = {self._drop_beyond:g} m: expected at least the radius, {self._radius:g} m"
            )
        self._folder = Path(folder)
        self._index = read_index(folder)
        self._window = _Window(None, np.zeros(len(self._index.names), np.bool_))
        rules = self._index.rules
        widest = self._index.bodies[-1].radius
        # an end is moved so far, has the body's radius around it, and floors depend on what is near them
        self._margin = 3.0 * widest + 4.0 * rules.resolution + rules.max_step / np.tan(rules.max_slope)

    def __repr__(self) -> str:
        loaded, names = int(self._window.loaded.sum()), len(self._index.names)
        return f"<OpenWorld {self._index.level}: {loaded} of {names} chunks loaded>"

    @property
    def graph(self) -> NodeGraph | None:
        """The fine graph of the chunks that are loaded: bit for bit what `NodeGraph.build` gives for them
        with the world's extent. None while nothing that can be walked on is loaded."""
        return self._window.graph

    @property
    def loaded(self) -> tuple[str, ...]:
        """Names of the chunks that are loaded, in alphabetical order."""
        return tuple(self._index.names[k] for k in np.flatnonzero(self._window.loaded))

    @property
    def chunks(self) -> tuple[str, ...]:
        """Names of all chunks, in alphabetical order."""
        return self._index.names

    @property
    def digest(self) -> str:
        """Hexadecimal digest of all chunks and of what the world was baked with, whatever is loaded."""
        index = self._index
        rules = None if index.obstacle_rules is None else sorted(index.obstacle_rules.to_dict().items())
        content = index.names, index.digests, sorted(index.rules.to_dict().items()), rules, self.radii
        return hashlib.sha256(repr(content).encode()).hexdigest()[:32]

    @property
    def radii(self) -> tuple[float, ...]:
        """[m] of the bodies that the world was baked for, rising."""
        return tuple(body.radius for body in self._index.bodies)

    def keep_around(self, points: Any, changes: int = 1) -> dict[str, Terrain | None]:
        """Load and drop up to so many chunks, at least 1, as ``points`` (3,) or (k, 3) [m] want it, and renew
        the graph: the nearest first, then the farthest are dropped. The same points and calls give the same
        graph.

        Returns what was changed, as `NodeGraph.update` takes it: by name the mesh of a chunk that was loaded,
        None for one that was dropped; empty when nothing is left to do. Takes the time of reading a chunk and
        of `NodeGraph.update` and `NodeGraph.prepare_like` for each: tens to hundreds of milliseconds, so call
        it in a thread of its own (one at a time), while others ask for routes on what was loaded before.
        Raises `ArchiveError` for a chunk's file that is missing or damaged; what is loaded is then as it was.
        """
        return self.change(self.next_changes(points, changes))

    def next_changes(
        self, points: Any, changes: int = 1, held: Any = (), needed: Any = ()
    ) -> tuple[str, ...]:
        """Names of the chunks that `keep_around` would load and drop with the same arguments, in order. None
        is dropped that is at most `navmesh.streaming.choosing.HOLD` [m] away from places ``held`` (m, 3) [m],
        and what makes places ``needed`` (n, 3) [m] be loaded (`is_loaded`) is loaded, too, however far away
        that is. Takes no time to speak of."""
        where, kept, extra = _points("points", points), _points("held", held), _points("needed", needed)
        if isinstance(changes, bool) or not isinstance(changes, Integral) or changes < 1:
            raise NavmeshError(f"changes = {changes!r}: expected a whole number of at least 1")
        bounds, loaded = self._index.bounds, self._window.loaded
        off, near = nearness(bounds, where), nearness(bounds, extra) <= self._margin
        wanted = (off <= self._radius) | near
        kept_too = (off <= self._drop_beyond) | (nearness(bounds, kept) <= HOLD) | near
        chosen = in_order(off, wanted & ~loaded, loaded & ~kept_too)
        return tuple(self._index.names[k] for k in chosen[: int(changes)])

    def change(self, names: Sequence[str]) -> dict[str, Terrain | None]:
        """Load those of the chunks ``names`` that are not loaded, and drop those that are; returns what was
        changed, takes the time and raises `ArchiveError` as `keep_around` does. Raises `NavmeshError` for
        names that no chunk has.

        A copy (`copy.copy`) has a window of its own: it can be changed in a thread while this world is used.
        """
        index, window = self._index, self._window
        chosen = self._numbers(names)
        if not chosen:
            return {}
        found = {
            index.names[k]: None if window.loaded[k] else read_chunk(self._folder, index, k) for k in chosen
        }
        loaded = window.loaded.copy()
        loaded[chosen] = ~loaded[chosen]
        self._window = _Window(self._renewed(window, found, loaded), loaded)
        return found

    def _renewed(
        self, window: _Window, changes: Mapping[str, Terrain | None], loaded: np.ndarray
    ) -> NodeGraph | None:
        """The graph of the ``loaded`` chunks, those of the ``window`` after ``changes``."""
        index = self._index
        if not loaded.any():
            return None
        if window.graph is not None:
            graph = _or_none(lambda graph=window.graph: graph.update(changes))
            if graph is not None:
                graph.prepare_like(window.graph)  # lest the first query after it has to
            return graph
        meshes = {
            index.names[k]: changes.get(index.names[k]) or read_chunk(self._folder, index, int(k))
            for k in np.flatnonzero(loaded)
        }
        terrain = join_chunks(meshes, index.level)
        return _or_none(
            lambda: NodeGraph.build(terrain, index.rules, index.obstacle_rules, extent=index.extent)
        )

    def chunk(self, name: str) -> Terrain:
        """The mesh of a chunk, loaded or not, read from its file. Raises `NavmeshError` for a name that no
        chunk has, `ArchiveError` for a file that is missing or damaged."""
        (number,) = self._numbers([name])
        return read_chunk(self._folder, self._index, number)

    def _numbers(self, names: Sequence[str]) -> list[int]:
        number = {name: k for k, name in enumerate(self._index.names)}
        unknown = sorted(set(names) - set(number))
        if unknown:
            raise NavmeshError(f"there is no chunk {unknown[0]!r} in {self._folder}; see OpenWorld.chunks")
        return [number[name] for name in names]

    def is_loaded(self, points: Any) -> np.ndarray:
        """Whether everything near each of ``points`` (k, 3) [m] is loaded, so that the fine graph can be
        asked there: (k,) bool."""
        return self._covers(self._window, _points("points", points))

    def _covers(self, window: _Window, points: np.ndarray) -> np.ndarray:
        missing = ~window.loaded
        return ~(distances(points, self._index.bounds[missing]) <= self._margin).any(axis=1)

    def route(
        self,
        start: Any,
        goal: Any,
        radius: float = 0.3,
        skills: Mapping[str, tuple[float, float]] | None = None,
    ) -> WorldRoute:
        """The route from ``start`` to ``goal`` (3,) [m] through the whole world for a body of ``radius`` [m],
        with ``skills`` as for `NodeGraph.find_path`.

        Where all chunks are loaded it is `NodeGraph.find_path`'s. Otherwise the coarse graph chooses the way,
        and the fine graph leads along it to the last coarse waypoint that is loaded. Whether the goal can be
        reached is known at once: the coarse graph joins what the fine graph of the whole joins, for a body of
        the least of `radii` that is not less than ``radius`` (so a slimmer one may get farther than it says).
        A goal that cannot be reached is replaced by the nearest place that can ("partial"), as in
        `find_path`, to half a cell. Raises `NavmeshError` for a radius above all of `radii` and arguments of
        a wrong kind.
        """
        first, last = _point("start", start), _point("goal", goal)
        radius, offered = checked_radius(radius), checked_skills(skills)
        body = self._body(radius)
        window = self._window
        if window.loaded.all() and window.graph is not None:
            fine = window.graph.find_path(first, last, radius, skills)
            return WorldRoute(fine.status, radius, fine if len(fine.waypoints) else None, np.empty((0, 3)))
        status, points, lengths = self._coarse_route(window, body, (first, last), radius, offered)
        if len(points) < 2:
            return WorldRoute(status, radius, None, np.empty((0, 3)))
        points[0] = first
        if status == "complete":
            points[-1] = last
        covered = self._covers(window, points)
        there = len(points) if covered.all() else int(np.argmin(covered))
        if window.graph is None or there == 0:
            return WorldRoute(status, radius, None, points, float(lengths.sum()))
        far = np.linalg.norm(points - first, axis=1) > _CLOSE
        for at in range(there - 1, 0, -1):
            if at == there - 1 and there < len(points):
                gained = np.linalg.norm(points[there] - first) - np.linalg.norm(points[there] - points[at])
                if gained <= 0.0:  # it is past this waypoint, at the end of what is loaded
                    continue
            fine = window.graph.find_path(first, points[at], radius, skills)
            if fine.status == "complete" and (far[at] or at == len(points) - 1):
                return WorldRoute(status, radius, fine, points[at + 1 :], float(lengths[at:].sum()))
        # the next coarse waypoint lies beyond what is loaded: as far as that goes towards it
        following = min(there, len(points) - 1)
        for place in self._toward(window, first, points[following]):
            fine = window.graph.find_path(first, place, radius, skills)
            if fine.status == "complete" and fine.length > 0.0:
                rest = float(np.linalg.norm(points[following] - place) + lengths[following:].sum())
                return WorldRoute(status, radius, fine, points[following:], rest)
        return WorldRoute(status, radius, None, points, float(lengths.sum()))

    def place_near(self, point: Any, radius: float = 0.3, anywhere: bool = False) -> np.ndarray | None:
        """The place (3,) [m] to which an end of a route at ``point`` (3,) [m] is moved for a body of
        ``radius`` [m], to half a cell; with ``anywhere`` the nearest place where it fits, however far away.
        Loaded or not; None where there is none. Raises `NavmeshError` as `route` does."""
        where, body = _point("point", point), self._body(checked_radius(radius))
        everywhere = np.ones(len(body.coarse.part), np.bool_) if anywhere else None
        region, place, _ = self._nearest(body, where, everywhere)
        return None if region < 0 else place

    def _body(self, radius: float) -> Body:
        """The least of the bodies that is not slimmer than ``radius`` [m]."""
        body = next((each for each in self._index.bodies if each.radius >= radius), None)
        if body is None:
            baked = ", ".join(f"{each:g}" for each in self.radii)
            raise NavmeshError(f"radius = {radius:g} m: the world was baked for bodies of up to {baked} m")
        return body

    def _nearest(
        self, body: Body, point: np.ndarray, among: np.ndarray | None = None
    ) -> tuple[int, np.ndarray, float]:
        """(region or -1, place (3,) [m], how far it is [m]): where an end of a route at ``point`` (3,) is
        moved; or the nearest place, however far, in the regions ``among`` (R,) bool."""
        rules, corner, foot = self._index.rules, self._index.corner, body.footprint
        limits, allowed = (inf, inf, 0.0), among
        if allowed is None:
            limits = 2.0 * body.radius + 2.0 * rules.resolution, 1.5 * rules.headroom, rules.max_step
            allowed = np.ones(len(body.coarse.part), np.bool_)
        region, place, off = foot.nearest(rules.resolution, point - corner, limits, allowed)
        return region, place + corner, off

    def _toward(self, window: _Window, start: np.ndarray, end: np.ndarray) -> np.ndarray:
        """Points (k, 3) [m] on the straight line from ``start`` to ``end`` that are loaded, the farthest
        first."""
        line = start + np.linspace(1.0, 0.0, _ALONG, endpoint=False)[:, None] * (end - start)
        there = line[self._covers(window, line)]
        if not len(there):
            return there
        return there[np.unique(np.linspace(0, len(there) - 1, _TRIED).round().astype(int))]

    def _ends(
        self, window: _Window, body: Body, region: int, place: np.ndarray, radius: float
    ) -> tuple[np.ndarray, np.ndarray]:
        """Terminals (k,) near a ``place`` (3,) [m] in a region, and how far they are (k,) [m]: by routes
        where these can be had, or else in a straight line."""
        coarse = body.coarse
        own = coarse.terminals_of(region)
        off = np.linalg.norm(coarse.place[own] - place, axis=1)
        near = np.argsort(off, kind="stable")[:AROUND]
        own, off = own[near], off[near]
        if window.graph is not None and self._covers(window, place[None])[0]:
            there = self._covers(window, coarse.place[own])
            routes = window.graph.find_paths(
                np.tile(place, (there.sum(), 1)), coarse.place[own[there]], radius
            )
            found = routes.status == "complete"
            if found.any():
                own, off = own[there][found], np.maximum(routes.length[found], off[there][found])
        return own, off

    def _coarse_route(
        self,
        window: _Window,
        body: Body,
        between: tuple[np.ndarray, np.ndarray],
        radius: float,
        skills: tuple,
    ) -> tuple[str, np.ndarray, np.ndarray]:
        """(status, points (k, 3) [m] from start to goal, lengths (k - 1,) [m] between them); no points where
        there is no way."""
        (start, goal), coarse = between, body.coarse
        nowhere = np.empty((0, 3)), np.empty(0)
        (begin, first, _), (end, last, _) = self._nearest(body, start), self._nearest(body, goal)
        if begin < 0 or end < 0:
            return "off_graph", *nowhere
        shut = np.ones(len(coarse.leap_target), np.bool_)
        for name, low, high in skills:
            fits = (coarse.leap_height >= low) & (coarse.leap_height <= high)
            shut &= ~((coarse.leap_kind == name) & fits)
        source, target = coarse.part[coarse.leap_from[~shut]], coarse.part[coarse.leap_to[~shut]]
        parts = int(coarse.part.max()) + 1
        reached = parts_reached(parts, int(coarse.part[begin]), source, target)
        status = "complete"
        if not reached[coarse.part[end]]:
            status = "partial"
            end, last, off = self._nearest(body, goal, reached[coarse.part])
            if np.linalg.norm(start - goal) <= off + _NEARER:
                return "no_path", *nowhere
        straight = float(np.linalg.norm(last - first))
        if begin == end and straight <= ANCHOR:
            return status, np.stack([first, last]), np.array([straight])
        ends = [
            self._ends(window, body, region, place, radius) for region, place in ((begin, first), (end, last))
        ]
        leaps = coarse.leap_start, coarse.leap_target, coarse.leap_cost, shut
        edges = coarse.edge_start, coarse.edge_target, coarse.edge_length
        length, chain, ways = shortest_chain(*edges, *leaps, coarse.place, *ends, tuple(last.tolist()))
        points = np.concatenate([first[None], coarse.place[chain], last[None]])
        to_first = ends[0][1][ends[0][0] == chain[0]]
        to_last = length - to_first.sum() - ways.sum()
        return status, points, np.concatenate([to_first, ways, [to_last]])


def _or_none(make: Any) -> NodeGraph | None:
    """The graph, or None where there is nothing to walk on."""
    try:
        return make()
    except NoFloorError:
        return None


def _length(name: str, value: Any) -> float:
    if isinstance(value, bool) or not isinstance(value, Real) or not isfinite(value) or value <= 0.0:
        raise NavmeshError(f"{name} = {value!r}: expected a length [m] above 0")
    return float(value)


def _points(name: str, values: Any) -> np.ndarray:
    try:
        points = np.atleast_2d(np.asarray(values, dtype=np.float64))
    except (TypeError, ValueError) as error:
        raise NavmeshError(f"{name}: expected coordinates (3,) or (k, 3) [m]: {error}") from None
    if points.size == 0:
        return np.empty((0, 3))
    if points.ndim != 2 or points.shape[1] != 3 or not np.isfinite(points).all():
        raise NavmeshError(f"{name}: expected finite coordinates (3,) or (k, 3) [m], not {values!r}")
    return points


def _point(name: str, value: Any) -> np.ndarray:
    points = _points(name, value)
    if len(points) != 1:
        raise NavmeshError(f"{name}: expected three numbers x, y, z [m], not {value!r}")
    return points[0].copy()
