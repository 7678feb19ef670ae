"""One body of a crowd and its goals."""

from __future__ import annotations

import hashlib
import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal, Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from locomotion.body_events import Arrived, Event, GotStuck, LostGround, SetOff
from locomotion.crowd import layout as at
from locomotion.errors import LocomotionError
from locomotion.quadruped.pool import Pool
from navmesh.graph.node_graph import NodeGraph
from navmesh.routes.route import Route

__all__ = ["NoRoute", "Walker", "WalkerState"]

Status = Literal["standing", "walking", "arrived", "stuck"]

_MOST_REPLANS = 3  # replans without progress before the body is stuck


class NoRoute(LocomotionError):
    """There is no route to goal number ``goal``: ``route`` is the answer for it from ``start`` (3,)."""

    def __init__(self, goal: int, route: Route, start: NDArray[np.float64]) -> None:
        self.goal, self.route, self.start = goal, route, start
        super().__init__(f"goal {goal} cannot be reached: {route.status}")


@dataclass(frozen=True)
class WalkerState:
    """Everything that a crowd stores of one body."""

    row: NDArray[np.float64]
    route: NDArray[np.float64]
    status: Status
    goals: tuple[tuple[float, float, float], ...]
    replans: int
    events: tuple[Event, ...]


class ItsCrowd(Protocol):
    """What a body asks of its crowd; members: as of `locomotion.crowd.crowd.Crowd`."""

    graph: NodeGraph
    dt: float
    routes: Pool

    @property
    def rows(self) -> NDArray[np.float64]: ...
    @property
    def origin(self) -> NDArray[np.float64]: ...
    def place(self, index: int) -> NDArray[np.float64]: ...
    def find_routes(
        self,
        index: int,
        goals: NDArray[np.float64],
        skills: Mapping[str, tuple[float, float]] | None = None,
        here: NDArray[np.float64] | None = None,
    ) -> list[Route]: ...
    def lay_routes(self, index: int, routes: list[Route]) -> None: ...
    def left(self, index: int) -> float: ...
    def way_left(self, index: int) -> NDArray[np.float64]: ...
    def goals_left(self, index: int) -> NDArray[np.float64]: ...
    def restore(self, index: int, row: NDArray[np.float64], route: NDArray[np.float64]) -> None: ...


class Walker:
    """One body of a crowd; created by `Crowd.add`.

    ``index`` is its row. ``status`` is "standing", "walking", "arrived" or "stuck" (no progress for 8 s with
    nobody near, or 300 s among others; or no route is left). ``events`` are in order of time.
    """

    def __init__(self, crowd: ItsCrowd, index: int) -> None:
        self.crowd, self.index = crowd, index
        self.status: Status = "standing"
        self.events: list[Event] = []
        self._goals: tuple[tuple[float, float, float], ...] = ()
        self._replans = 0

    @property
    def _row(self) -> NDArray[np.float64]:
        return self.crowd.rows[self.index]

    @property
    def time(self) -> float:
        """[s] since it was created."""
        return float(self._row[at.AGE]) * self.crowd.dt

    @property
    def position(self) -> NDArray[np.float64]:
        """(3,) float64 [m]: the floor point under it."""
        return self.crowd.place(self.index)

    @property
    def velocity(self) -> NDArray[np.float64]:
        """(2,) float64 [m/s]."""
        return self._row[[at.VX, at.VY]]

    @property
    def yaw(self) -> float:
        """[rad, -π to π] direction it faces."""
        return float(self._row[at.YAW])

    @property
    def radius(self) -> float:
        """[m]"""
        return float(self._row[at.RADIUS])

    @property
    def acceleration(self) -> float:
        """[m/s²]"""
        return float(self._row[at.ACCELERATION])

    @property
    def left(self) -> float:
        """[m] left of its route."""
        return self.crowd.left(self.index)

    @property
    def queues(self) -> bool:
        """Whether it waits for its turn at a narrow place."""
        return bool(self._row[at.PASSAGE] in (at.WAITING, at.RETREATING))

    def go_to(self, goals: ArrayLike, speed: float = 1.4, facing: float | None = None) -> list[Route]:
        """Go through ``goals`` (k, 3) [m] at up to ``speed`` [m/s], then face ``facing`` [rad], by default as
        it arrives. Returns the routes to them.

        Raises `NoRoute` if there is none, and `LocomotionError` for numbers that are not finite or a speed
        that is not above 0; the body then continues as before.
        """
        points = np.asarray(goals, dtype=np.float64)
        if points.ndim != 2 or points.shape[1] != 3 or not len(points) or not np.isfinite(points).all():
            raise LocomotionError(f"goals must be finite (k, 3), not {goals!r}")
        if not (math.isfinite(speed) and speed > 0.0):
            raise LocomotionError(f"speed must be a finite number above 0 m/s, not {speed!r}")
        if facing is not None and not math.isfinite(facing):
            raise LocomotionError(f"facing must be a finite angle, not {facing!r}")
        if self._row[at.MODE] == at.LED:
            raise LocomotionError("there is no floor under it; it cannot go anywhere")
        routes = self.crowd.find_routes(self.index, points)
        if self._row[at.MODE] == at.ROOTED:
            self._row[at.WEIGHT] = 1.0
        self._row[at.WISH], self._row[at.FACING] = speed, math.nan if facing is None else facing
        self.crowd.lay_routes(self.index, routes)
        self._goals = tuple((float(x), float(y), float(z)) for x, y, z in points)
        self._replans, self.status = 0, "walking"
        self.events.append(SetOff(self.time, self._point(), self._goals[-1], self.left))
        return routes

    def lose_ground(self) -> None:
        """Its floor is gone: become stuck without moving. Called by `Crowd.change_graph`."""
        if self._row[at.MODE] != at.LED:
            self.hang()
            self.events.append(LostGround(self.time, self._point()))

    def hang(self) -> None:
        """Be stuck where it is, without a floor and without moving."""
        row = self._row
        row[[at.VX, at.VY, at.GO_X, at.GO_Y]] = 0.0
        row[at.MODE], row[at.CELL], row[at.NOTE], row[at.WEIGHT] = at.LED, -1.0, at.QUIET, 1.0
        self.status = "stuck"

    def root(self) -> None:
        """Stay where it is, whoever wants by, until `stop` or `go_to`."""
        row = self._row
        if row[at.MODE] != at.LED:
            row[[at.VX, at.VY, at.GO_X, at.GO_Y]] = 0.0
            row[at.MODE], row[at.NOTE], row[at.WEIGHT] = at.ROOTED, at.QUIET, at.UNMOVED
            self.status = "standing"

    def carry(self, place: NDArray[np.float64], velocity: NDArray[np.float64], yaw: float) -> None:
        """Be moved by somebody else until `put_down`: be at ``place`` (3,) [m], which may be off the surface,
        with ``velocity`` (2,) [m/s], and face ``yaw`` [rad]."""
        row = self._row
        row[at.X : at.Z + 1] = place - self.crowd.origin
        row[[at.VX, at.VY]] = row[[at.GO_X, at.GO_Y]] = velocity
        row[at.YAW] = yaw
        row[at.MODE], row[at.CELL], row[at.NOTE], row[at.WEIGHT] = at.LED, -1.0, at.QUIET, at.UNMOVED
        self.status = "walking"

    def put_down(self) -> bool:
        """Stand on the surface again, where it is; False where there is none under it."""
        row = self._row
        cells, floors = self.crowd.graph.project(self.position[None])
        if cells[0] < 0 or abs(floors[0] - self.position[2]) > self.crowd.graph.rules.headroom:
            return False
        row[at.CELL], row[at.Z] = cells[0], floors[0] - self.crowd.origin[2]
        row[at.MODE], row[at.WEIGHT] = at.STANDING, 1.0
        self.status = "standing"
        return True

    def stop(self) -> None:
        """Stop here."""
        if self._row[at.MODE] == at.LED:
            return
        if self._row[at.MODE] == at.ROOTED:
            self._row[at.WEIGHT] = 1.0
        self._row[at.MODE], self._row[at.NOTE] = at.STANDING, at.QUIET
        self.status = "standing"

    def notice(self) -> None:
        """Act on the last tick's message; called by `Crowd.tick`."""
        row = self._row
        note, row[at.NOTE] = row[at.NOTE], at.QUIET
        if note == at.OFF_ROUTE and self._replan():
            return
        self.stop()
        if note == at.ARRIVED:
            distance = float(np.hypot(row[at.GOAL_X] - row[at.X], row[at.GOAL_Y] - row[at.Y]))
            self.status = "arrived"
            self.events.append(Arrived(self.time, self._point(), distance))
        else:
            self.status = "stuck"
            self.events.append(GotStuck(self.time, self._point()))

    def _replan(self) -> bool:
        """Replan to the remaining goals; False if there is no route."""
        row = self._row
        self._replans = self._replans + 1 if row[at.WAITED] > 2.0 else 0
        if self._replans > _MOST_REPLANS:
            return False
        waited, alone = row[[at.WAITED, at.ALONE]]
        goals = self.crowd.goals_left(self.index)
        try:
            self.crowd.lay_routes(self.index, self.crowd.find_routes(self.index, goals))
        except NoRoute:
            return False
        row[at.BEST], row[at.WAITED], row[at.ALONE] = self.left, waited, alone
        return True

    def _point(self) -> tuple[float, float, float]:
        x, y, z = self.position.tolist()
        return x, y, z

    # --- saving
    def save(self) -> WalkerState:
        """Everything needed to continue from here."""
        return WalkerState(
            self._row.copy(), self.crowd.routes.table(self.index), self.status, self._goals, self._replans,
            tuple(self.events),
        )  # fmt: skip

    def restore(self, state: WalkerState) -> None:
        """Restore a state of this body."""
        self.crowd.restore(self.index, state.row, state.route)
        self.status, self._goals, self._replans = state.status, state.goals, state.replans
        self.events[:] = state.events

    def state_hash(self) -> str:
        """Hex digest of everything that decides its future."""
        row = self._row.copy()
        row[at.ROUTE_START] = row[at.GATE_START] = 0.0  # positions in the pools do not count
        hasher = hashlib.sha256(row.tobytes())
        hasher.update(self.crowd.routes.table(self.index).tobytes())
        return f"{hasher.hexdigest()[:16]}{self.status}{self._replans}"
