"""The open world of a world: which of its chunks are loaded, and which come and go next.

Every half second of simulated time the next chunks are chosen by where players and agents are, and half a
second later they are there. Both are counted in ticks, so a run does not depend on how long the work takes.
"""

from collections.abc import Callable, Mapping
from copy import copy
from dataclasses import dataclass

import numpy as np

import navmesh
from runtime.errors import RuntimeInputError
from runtime.planning.level import Level
from runtime.world.agent import Agent
from runtime.world.arguments import checked_points
from runtime.world.upcoming import Upcoming

__all__ = ["CHANGES", "EVERY", "Player", "Streaming", "StreamingState", "checked_players"]

EVERY = 50
"""Ticks from one change of chunks to the next."""
CHANGES = 2
"""Chunks in each at most."""

_SPACING = 5.0  # [m]

Player = str | tuple[float, float, float]
"""An agent's name, or a place [m]."""
_Loaded = tuple[navmesh.OpenWorld, Level | None]


@dataclass(frozen=True)
class StreamingState:
    """What `World.save` keeps: which chunks are ``loaded``, around which ``players``, and which are being
    ``changed``."""

    loaded: tuple[str, ...]
    players: tuple[Player, ...] = ()
    changed: tuple[str, ...] = ()


class Streaming:
    """What a world has of ``world``: a copy, so that several worlds can be made of one.

    The next chunks are worked out in a thread of their own. ``level_of(graph)``: the level of a graph, asked
    for there. Attributes: world: the open world as it is loaded now. players: around whom chunks are kept.
    """

    def __init__(
        self, world: navmesh.OpenWorld, level_of: Callable[[navmesh.NodeGraph], Level] = Level.of
    ) -> None:
        self.world = copy(world)
        self.players: tuple[Player, ...] = ()
        self._changed: tuple[str, ...] = ()
        self._level_of = level_of
        self._upcoming: Upcoming[_Loaded, tuple[str, ...]] = Upcoming(self._made)

    def level(self) -> Level:
        """The level that is loaded. Raises `RuntimeInputError` if nobody can stand anywhere."""
        graph = self.world.graph
        if graph is None:
            raise RuntimeInputError(
                "nothing that one can walk on is loaded of the open world; call its "
                "keep_around(places, changes=100) first, with the places where the first agents appear"
            )
        return Level.of(graph)

    def turn(self, agents: Mapping[str, Agent]) -> Level | None:
        """Every `EVERY` ticks: take the change that was begun, and begin the next one, around the players as
        they are now. Returns the level if it has changed. Raises `ArchiveError` for a chunk that cannot be
        read, which is not taken then."""
        level = self._end()
        if self.players:
            people = [agents[each] for each in self.players if isinstance(each, str)]
            places = [each for each in self.players if not isinstance(each, str)]
            around = np.array([*(each.position for each in people), *places])
            held = np.concatenate([_held(agents), *(_line(each.position, each.told_to) for each in people)])
            needed = [np.empty((0, 3)), *(_line(each.position, each.waits_for) for each in people)]
            self._begin(self.world.next_changes(around, CHANGES, held, np.concatenate(needed)))
        return level

    def keep_around(
        self, places: object, changes: int, agents: Mapping[str, Agent]
    ) -> tuple[Level | None, dict[str, navmesh.Terrain | None]]:
        """As `navmesh.OpenWorld.keep_around`, at once, but nobody's ground is dropped: the level, None if it
        is as before, and what has changed."""
        later = copy(self.world)
        found = later.change(later.next_changes(places, changes, _held(agents)))
        if not found or later.graph is None:
            return None, {}
        self._drop()
        self.world = later
        return self._level_of(later.graph), found

    def forget(self, name: str) -> None:
        """An agent is not here any more."""
        self.players = tuple(each for each in self.players if each != name)

    def save(self) -> StreamingState:
        """Everything that decides how it goes on."""
        return StreamingState(self.world.loaded, self.players, self._changed)

    def load(self, state: StreamingState) -> Level | None:
        """Have loaded what was loaded in ``state``, and changed what was being changed: the level, None if it
        is as before. Raises `RuntimeInputError` for what no state of this world can be."""
        loaded, changed = set(state.loaded), set(state.changed)
        places = [each for each in state.players if not isinstance(each, str)]
        if not np.isfinite(places).all():
            raise RuntimeInputError("the state has a player whose place is not finite")
        if not loaded | changed <= set(self.world.chunks):
            raise RuntimeInputError("the state has chunks that this open world does not have")
        names = tuple(sorted(loaded ^ set(self.world.loaded)))
        later, level = self._made((self.world, None), names) if names else (self.world, None)
        if names and level is None:
            raise RuntimeInputError("nobody can stand anywhere on the chunks of the state")
        self._drop()
        self.world = later
        self._begin(state.changed)
        return level

    def _made(self, before: _Loaded, names: tuple[str, ...]) -> _Loaded:
        """The world after a change of chunks; no level where nobody could stand anywhere then."""
        later = copy(before[0])
        later.change(names)
        return later, None if later.graph is None else self._level_of(later.graph)

    def _begin(self, names: tuple[str, ...]) -> None:
        self._changed = names
        if names:
            self._upcoming.begin((self.world, None), names)

    def _end(self) -> Level | None:
        if not self._changed:
            return None
        self._changed = ()
        later, level = self._upcoming.end()
        if level is not None:
            self.world = later
        return level

    def _drop(self) -> None:
        self._changed = ()
        self._upcoming.drop()


def checked_players(players: object, agents: Mapping[str, Agent]) -> tuple[Player, ...]:
    """``players``, agents or places (3,) [m], as they are kept. Raises `RuntimeInputError` for anything
    else, and for agents that are not among ``agents``."""
    if not isinstance(players, list | tuple):
        raise RuntimeInputError(f"players must be a list of agents and places (3,) [m], not {players!r}")
    return tuple(_checked_player(each, agents) for each in players)


def _checked_player(player: object, agents: Mapping[str, Agent]) -> Player:
    if isinstance(player, Agent):
        if agents.get(player.name) is not player:
            raise RuntimeInputError(f"{player.name} is not in this world")
        return player.name
    point = checked_points(player, "a player that is no agent")  # type: ignore[arg-type]
    if point.shape != (1, 3):
        raise RuntimeInputError(f"a player is an agent or one place (3,) [m], not {player!r}")
    x, y, z = point[0].tolist()
    return x, y, z


def _line(start: np.ndarray, end: tuple[float, float, float] | None) -> np.ndarray:
    """Points (k, 3) [m] from ``start`` to ``end``, some metres apart; none without an end."""
    if end is None:
        return np.empty((0, 3))
    count = int(np.linalg.norm(np.array(end) - start) / _SPACING) + 2
    return np.linspace(start, np.array(end), count)


def _held(agents: Mapping[str, Agent]) -> np.ndarray:
    """(m, 3) [m]: where those are whom this world moves."""
    here = [each.position for each in agents.values() if not each.driver.comes_from_elsewhere]
    return np.array(here).reshape(-1, 3)
