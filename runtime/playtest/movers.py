"""How a bot's body gets about: a capsule on the triangles, or a body of a world that runs for it alone."""

import math
from collections import deque
from copy import copy
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from locomotion.skills.registry import skill_called
from navmesh.routes.route import Route
from runtime.errors import RuntimeInputError
from runtime.events import SkillFinished, SkillStarted
from runtime.playtest import feet
from runtime.playtest.looks import POSED
from runtime.playtest.site import Site
from runtime.world.world import World

__all__ = ["CapsuleMover", "Leg", "Mover", "WorldMover", "mover_of", "planned_time"]

STATUSES = ("arrived", "stuck", "fell", "bumped", "out of time")
_MOST = 4096  # samples of a leg's track
_POSES = 5  # in each of them
_SAMPLE = _POSES * POSED  # [s] between samples of a track
_SHOWN = 6.0  # [s] of which the poses are remembered
_TURNS, _ROOM = 12, 2.0  # headings in which a body might appear, and [m] of room that is enough before it
_STRAIGHT = 3.0  # [s] that a body of a world goes straight on, where it can
_WORDS = {"arrived": "arrived", "stuck": "stuck", "fallen": "fell", "lost": "lost", "blocked": "no way"}


@dataclass(frozen=True)
class Leg:
    """How one way went.

    ``status``: "arrived", "stuck", "fell", "bumped" (against the level, in a leap), "lost" (left its
    path), "no way" or "out of time"; ``seconds`` it took, ``planned`` [s] it should have taken (0 for
    wandering); ``track`` (n, 4) float64: time since its beginning [s] and place [m]; ``place`` (3,) where it
    ended; ``obstacle`` the one that a leap ended at, or -1.
    """

    status: str
    seconds: float
    planned: float
    track: np.ndarray
    place: np.ndarray
    obstacle: int = -1


class Mover(Protocol):
    """A bot's body. ``place`` (3,) float64 [m]."""

    place: np.ndarray

    @property
    def poses(self) -> np.ndarray | None:
        """(k, b, 7) float32: the transforms of its bodies in its last seconds, every `POSED` s; None where
        they follow from its track."""
        ...

    def appear(self, place: np.ndarray, heading: float) -> None:
        """Stand at ``place`` (3,), as new, facing ``heading`` [rad], or another way where it needs room."""
        ...

    def travel(self, route: Route, time_limit: float) -> Leg:
        """Follow ``route``, which begins where it is."""
        ...

    def wander(self, headings: np.ndarray, time_limit: float) -> Leg:
        """Go straight on, in the next of ``headings`` (h,) [rad] where it cannot."""
        ...


def planned_time(route: Route, speed: float) -> float:
    """[s] that ``route`` takes at ``speed`` [m/s]."""
    return route.length / speed + 0.3 * len(route.links)


class CapsuleMover:
    """The capsule of `runtime.playtest.feet`."""

    poses: np.ndarray | None = None

    def __init__(self, site: Site) -> None:
        self._site = site
        character, rules = site.character, site.graph.rules
        self._limits = np.array(
            [character.radius, rules.max_step, rules.headroom, character.reach("off"), character.stride]
        )
        self.place = np.zeros(3)
        self._heading = 0.0

    def appear(self, place: np.ndarray, heading: float) -> None:
        self.place, self._heading = np.array(place, dtype=np.float64), heading

    def travel(self, route: Route, time_limit: float) -> Leg:
        site = self._site
        origin, links = site.graph.surface.origin, site.graph.links
        points = route.waypoints - origin
        leaps = np.zeros(len(points), dtype=bool)
        edges = np.zeros((len(points), 3))
        over = np.full(len(points), -1)
        for use in route.links:
            leaps[use.last] = True
            edges[use.last] = links.edge[use.link] - origin
            over[use.last] = use.obstacle
        here, track = self.place - origin, np.empty((_MOST, 4))
        end, seconds, self._heading, count, reached = feet.follow(
            site.mesh_grid.arrays, here, self._heading, points, leaps, edges, site.character.speed,
            self._limits, time_limit, track,
        )  # fmt: skip
        obstacle = int(over[reached]) if reached < len(points) else -1
        return self._leg(
            STATUSES[end], seconds, planned_time(route, site.character.speed), track[:count], here, obstacle
        )

    def wander(self, headings: np.ndarray, time_limit: float) -> Leg:
        site = self._site
        here, track = self.place - site.graph.surface.origin, np.empty((_MOST, 4))
        end, seconds, count = feet.roam(
            site.mesh_grid.arrays, here, headings, site.character.speed, self._limits, time_limit, track
        )
        return self._leg(STATUSES[end], seconds, 0.0, track[:count], here, -1)

    def _leg(self, status, seconds, planned, track, here, obstacle) -> Leg:
        origin = self._site.graph.surface.origin
        self.place = here + origin
        track = track.copy()
        track[:, 1:] += origin
        return Leg(status, float(seconds), planned, track, self.place.copy(), obstacle)


class WorldMover:
    """A body of `runtime.World` that has a world to itself; of an open world that is loaded around it."""

    def __init__(self, site: Site) -> None:
        self._site = site
        self.place = np.zeros(3)
        self.world: World | None = None
        self._poses: deque[np.ndarray] = deque(maxlen=round(_SHOWN / POSED))

    @property
    def poses(self) -> np.ndarray | None:
        return np.array(self._poses, dtype=np.float32)

    def appear(self, place: np.ndarray, heading: float) -> None:
        self.world = self._world_around(place)
        headings = self._headings(place, heading)
        for each in headings:
            try:
                self._agent = self.world.spawn(self._site.character.body, place, each)
                break
            except RuntimeInputError:  # no room for its head beside a wall
                if each == headings[-1]:
                    raise
        if self._site.open_world is not None:
            self.world.players = [self._agent]
        self.place = self._agent.position
        self._poses.clear()

    def _world_around(self, place: np.ndarray) -> World:
        """A world in which it can appear at ``place`` (3,)."""
        around = self._site.open_world
        if around is None:
            return World(self._site.graph)
        if self.world is not None:  # not all chunks are others than before
            around = self.world.open_world or around
        around = copy(around)
        around.keep_around(place, len(around.chunks))
        return World(around)

    def _headings(self, place: np.ndarray, wanted: float) -> list[float]:
        """Headings for one who appears, who has no trail to back out along: first those with room ahead, the
        nearest to the ``wanted`` one first."""
        aside = 2.0 * math.pi * np.arange(_TURNS) / _TURNS
        rays = _ROOM * np.column_stack([np.cos(wanted + aside), np.sin(wanted + aside), np.zeros(_TURNS)])
        radius = self._site.character.radius
        ends = [self._site.graph.cast_ray(place, place + ray, radius=radius).end for ray in rays]
        room = np.linalg.norm(np.array(ends) - place, axis=1).round(2)
        order = np.lexsort((np.minimum(aside, 2.0 * math.pi - aside), -room))
        return (wanted + aside[order]).tolist()

    def travel(self, route: Route, time_limit: float) -> Leg:
        assert self.world is not None
        world, agent, speed = self.world, self._agent, self._site.character.speed
        begun, before = world.time, agent.position
        agent.go_to(route.waypoints[-1], speed=speed)
        planned = planned_time(route, speed) if agent.status != "blocked" else 0.0
        track = [(0.0, *before)]
        cleared = -1
        while (agent.moving or agent.status == "waiting") and world.time - begun < time_limit:
            for _ in range(_POSES):
                world.step(POSED)
                self._poses.append(agent.pose.transforms)
            track.append((world.time - begun, *agent.position))
        for event in world.events:
            if isinstance(event, SkillStarted):
                cleared = self._site.graph.obstacles.near(
                    np.array(event.position), skill_called(event.skill).affordance
                )[0]
            elif isinstance(event, SkillFinished):
                cleared = -1
        self.place = agent.position
        status = _WORDS.get(agent.status, "out of time")
        return Leg(status, world.time - begun, planned, np.array(track), self.place.copy(), cleared)

    def wander(self, headings: np.ndarray, time_limit: float) -> Leg:
        # a body that follows paths wanders from place to place straight ahead of it
        site, here = self._site, self.place
        far = site.character.speed * min(time_limit, _STRAIGHT)
        ahead = here + far * np.array([math.cos(headings[0]), math.sin(headings[0]), 0.0])
        end = site.graph.cast_ray(here, ahead, radius=site.character.radius).end
        route = site.graph.find_path(here, end, radius=site.character.radius)
        if route.status != "complete" or route.length < 1.0:
            return Leg("arrived", _SAMPLE, 0.0, np.empty((0, 4)), here.copy())
        return self.travel(route, time_limit)


def mover_of(site: Site) -> Mover:
    """A body of the site's character."""
    return CapsuleMover(site) if site.character.slides else WorldMover(site)
