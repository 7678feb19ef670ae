"""A crowd: many bodies on one surface in flat arrays; one call advances all of them.

crowd = Crowd(graph)
ada = crowd.add((2.0, 3.0, 0.0), radius=0.3)
ada.go_to([(9.0, 3.0, 0.0)], speed=1.4)
while ada.status == "walking":
    crowd.tick()
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

import navmesh
from locomotion.crowd import layout as at
from locomotion.crowd.discs import add_discs, write_discs
from locomotion.crowd.gates import ABREAST, Gates, find_gates, foresee_gates
from locomotion.crowd.queueing import trace_gates
from locomotion.crowd.tick import advance_all
from locomotion.crowd.walker import NoRoute, Walker, WalkerState
from locomotion.errors import LocomotionError
from locomotion.quadruped.pool import Pool
from navmesh.graph.kernel_arrays import net_of
from navmesh.graph.snapping import snap
from navmesh.graph.spatial_queries import project
from navmesh.routes.route import Route
from navmesh.surface.clearance_field import floor_at

__all__ = ["Crowd"]

_MOST_RADIUS = 10.0  # [m]


class Crowd:
    """Bodies that walk on the surface of ``graph`` and avoid each other.

    ``graph`` is replaced by `change_graph`. ``dt`` [s] is the length of a tick. Equal calls give
    bit-identical runs. ``walkers`` are the bodies in order of creation; ``routes`` holds their routes by
    index.
    """

    def __init__(self, graph: navmesh.NodeGraph, dt: float = 0.01) -> None:
        if not (math.isfinite(dt) and 0.0 < dt <= 0.1):
            raise LocomotionError(f"dt must be above 0 and at most 0.1 s, not {dt!r}")
        self.graph, self.dt = graph, dt
        self.walkers: list[Walker] = []
        self._table = np.zeros((64, at.ROW))
        self._count = self._led = 0
        self.routes = Pool(at.POINT)
        self._crossings = Pool(at.CROSSING)
        self._gates: Gates | None = None
        self._widest = 0.0
        self._net = net_of(graph)
        self._origin = graph.surface.origin

    def __len__(self) -> int:
        return self._count

    @property
    def rows(self) -> NDArray[np.float64]:
        """(n, `layout.ROW`) the state of all bodies; a view."""
        return self._table[: self._count]

    @property
    def net(self) -> Any:
        """The surface and the graph, as kernels know them."""
        return self._net

    @property
    def origin(self) -> NDArray[np.float64]:
        """(3,) float64 [m] that coordinates of kernels are relative to."""
        return self._origin

    @property
    def positions(self) -> NDArray[np.float64]:
        """(n, 3) float64 [m]: the floor points under the bodies."""
        return self.rows[:, at.X : at.Z + 1] + self._origin

    @property
    def places_of_all(self) -> NDArray[np.float64]:
        """(n + k, 3) float64 [m]: the same, then where those are that `lead` was told of."""
        return self._table[: self._count + self._led, at.X : at.Z + 1] + self._origin

    def place(self, index: int) -> NDArray[np.float64]:
        """(3,) float64 [m]: the floor point under one body."""
        return self._table[index, at.X : at.Z + 1] + self._origin

    @property
    def velocities(self) -> NDArray[np.float64]:
        """(n, 2) float64 [m/s]."""
        return self.rows[:, [at.VX, at.VY]]

    @property
    def radii(self) -> NDArray[np.float64]:
        """(n,) float64 [m]."""
        return self.rows[:, at.RADIUS]

    @property
    def yaws(self) -> NDArray[np.float64]:
        """(n,) float64 [rad, -π to π]."""
        return self.rows[:, at.YAW]

    def discs(self) -> NDArray[np.float64]:
        """(n, 6) the bodies as `lead` takes those of others."""
        discs = np.empty((self._count, 6))
        write_discs(self._table, self._origin, discs)
        return discs

    def add(
        self, position: ArrayLike, radius: float = 0.3, yaw: float = 0.0, acceleration: float = 4.0
    ) -> Walker:
        """Add a standing body of ``radius`` [m] at ``position`` (3,) [m], facing ``yaw`` [rad].

        ``acceleration`` [m/s²] limits the change of its velocity. Raises `LocomotionError` for numbers out of
        range, or if there is no room for it near that place.
        """
        place = np.asarray(position, dtype=np.float64)
        if place.shape != (3,) or not np.isfinite(place).all() or not math.isfinite(yaw):
            raise LocomotionError(
                f"position and yaw must be finite (3,) and (), not {position!r} and {yaw!r}"
            )
        if not 0.0 < radius <= _MOST_RADIUS:
            raise LocomotionError(f"radius must be above 0 and at most {_MOST_RADIUS:g} m, not {radius!r}")
        if not (math.isfinite(acceleration) and acceleration > 0.0):
            raise LocomotionError(f"acceleration must be a finite number above 0 m/s², not {acceleration!r}")
        row = self._new_row()
        row[at.RADIUS], row[at.ACCELERATION], row[at.WEIGHT], row[at.YAW] = radius, acceleration, 1.0, yaw
        row[at.WISH], row[at.FACING] = 1.4, math.nan
        row[at.X : at.Z + 1] = place - self._origin
        row[at.GOAL_X : at.GOAL_Z + 1] = row[at.X : at.Z + 1]
        if not self._put_down(row):
            raise LocomotionError(
                f"there is no room for a radius of {radius:g} m near {place.round(2).tolist()}"
            )
        return self._take_in()

    def adopt(self, state: WalkerState) -> Walker:
        """Add a body in a saved state."""
        self._new_row()
        walker = self._take_in()
        walker.restore(state)
        return walker

    def remove(self, index: int) -> None:
        """Remove a body; the indices of those after it decrease by one."""
        self._table = np.delete(self._table, index, axis=0)
        self._table = np.vstack([self._table, np.zeros(at.ROW)])
        self._count -= 1
        self._led = 0
        self.routes.remove(index)
        self._crossings.remove(index)
        del self.walkers[index]
        for later in self.walkers[index:]:
            later.index -= 1

    def _take_in(self) -> Walker:
        """Make the row of `_new_row` part of the crowd."""
        self._count += 1
        self._heed(self._count - 1)
        self.walkers.append(Walker(self, self._count - 1))
        return self.walkers[-1]

    def _new_row(self) -> NDArray[np.float64]:
        """A row of zeros behind the last one, not part of the crowd yet."""
        if self._count == len(self._table):
            self._double()
        self._led = 0
        self._table[self._count] = 0.0
        return self._table[self._count]

    def _double(self) -> None:
        self._table = np.concatenate([self._table, np.zeros_like(self._table)])

    def _put_down(self, row: NDArray[np.float64]) -> bool:
        """Move a body to the nearest place where it fits; False if there is none."""
        radius = float(row[at.RADIUS])
        reach = 2.0 * (radius + self.graph.surface.resolution)
        x, y, z = row[at.X : at.Z + 1].tolist()
        rules = self.graph.rules
        node, cell, x, y = snap(self._net, x, y, z, radius, reach, rules.headroom, rules.max_step)
        if node < 0:
            return False
        row[at.X], row[at.Y], row[at.CELL] = x, y, cell
        row[at.Z] = floor_at(self._net, cell, x, y)
        return True

    def shift(self, index: int, way: NDArray[np.float64]) -> None:
        """Move a body by ``way`` (3,) [m], a short one, if the surface is clear for it there."""
        row, there = self.rows[index], self.place(index) + way
        cells, floors = self.graph.project(there[None])
        if cells[0] >= 0 and self.graph.clearance_at(there) >= row[at.RADIUS]:
            row[at.X], row[at.Y], row[at.Z] = [*there[:2], floors[0]] - self._origin
            row[at.CELL] = cells[0]

    # --- routes
    def find_routes(
        self,
        index: int,
        goals: NDArray[np.float64],
        skills: Mapping[str, tuple[float, float]] | None = None,
        here: NDArray[np.float64] | None = None,
    ) -> list[Route]:
        """One route for each of ``goals`` (k, 3) [m], in series from ``here`` (3,), by default from where the
        body is; over obstacles that ``skills`` clear, as of `NodeGraph.find_path`. Raises `NoRoute`."""
        begin = self.place(index) if here is None else here
        radius = float(self.rows[index, at.RADIUS])
        routes: list[Route] = []
        for goal in goals:
            route = self.graph.find_path(begin, goal, radius=radius, skills=skills)
            if route.status != "complete":
                raise NoRoute(len(routes), route, begin)
            routes.append(route)
            begin = route.waypoints[-1]
        return routes

    def lay_routes(self, index: int, routes: list[Route]) -> None:
        """Let a body follow ``routes``, the first of which begins where it is, and visit the end of each."""
        counts = [max(len(route.waypoints) - 1, 1) for route in routes]
        table = np.zeros((1 + sum(counts), at.POINT))
        table[1:, :3] = np.concatenate([r.waypoints[-n:] for r, n in zip(routes, counts, strict=True)])
        table[1:, :3] -= self._origin
        table[np.cumsum(counts), at.VIA] = 1.0
        self._lay(index, table)
        self.rows[index, at.GOAL_X : at.GOAL_Z + 1] = table[-1, :3]

    def _lay(self, index: int, table: NDArray[np.float64]) -> None:
        """Let a body follow the corners of ``table``, of which the first is replaced by its place."""
        row = self.rows[index]
        table[0, :3] = row[at.X : at.Z + 1]
        legs = np.hypot(*np.diff(table[:, :2], axis=0).T)
        table[:-1, at.LEFT] = np.cumsum(legs[::-1])[::-1]
        self._keep_route(index, table)
        row[at.NEXT], row[at.BLIND], row[at.LEFT_NOW] = 1.0, 0.0, table[0, at.LEFT]
        row[at.GATE_NEXT], row[at.PASSAGE], row[at.GATE_WAIT] = 0.0, at.FAR, 0.0
        row[at.RIGHT_UNTIL] = math.inf
        row[at.BEST], row[at.WAITED], row[at.ALONE] = math.inf, 0.0, 0.0
        row[at.MODE], row[at.NOTE] = at.WALKING, at.QUIET

    def left(self, index: int) -> float:
        """[m] left of a body's route."""
        row = self._table[index].tolist()
        if row[at.MODE] != at.WALKING:
            return 0.0
        point = self.routes.rows[int(row[at.ROUTE_START] + row[at.NEXT])].tolist()
        return float(np.hypot(point[0] - row[at.X], point[1] - row[at.Y])) + point[at.LEFT]

    def goals_left(self, index: int) -> NDArray[np.float64]:
        """(k, 3) [m]: the places that a walking body has still to visit."""
        ahead = self.routes.table(index)[int(self.rows[index, at.NEXT]) :]
        return ahead[ahead[:, at.VIA] > 0.0][:, :3] + self._origin

    def way_left(self, index: int) -> NDArray[np.float64]:
        """(k, 3) [m]: a walking body's place and the remaining corners of its route."""
        ahead = self.routes.table(index)[int(self.rows[index, at.NEXT]) :, :3]
        return np.vstack([self.rows[index, at.X : at.Z + 1], ahead]) + self._origin

    def restore(self, index: int, row: NDArray[np.float64], route: NDArray[np.float64]) -> None:
        """Restore a row and a route."""
        self.rows[index] = row
        self._heed(index)
        self._keep_route(index, route)

    def _keep_route(self, index: int, table: NDArray[np.float64]) -> None:
        if self.routes.put(index, table):
            for other in range(len(self)):
                self._table[other, at.ROUTE_START] = self.routes.region(other)[0]
        self.rows[index, [at.ROUTE_START, at.ROUTE_COUNT]] = self.routes.region(index)
        if self._gates is not None:
            self._trace_gates(index)

    def _heed(self, index: int) -> None:
        """Account for a body's width."""
        if self.rows[index, at.RADIUS] > self._widest:
            self._widest, self._gates = float(self.rows[index, at.RADIUS]), None

    def expect(self, radius: float) -> None:
        """Find the gates for bodies of up to ``radius`` [m] now: it takes time in proportion to the level."""
        if radius > self._widest or self._gates is None:
            self._widest = max(radius, self._widest)
            self._find_gates()

    def _find_gates(self) -> Gates:
        gates = self._gates = find_gates(self.graph, ABREAST * self._widest)
        for index in range(len(self)):
            self._trace_gates(index)
        return gates

    def _trace_gates(self, index: int) -> None:
        """Record the gates on a body's route."""
        assert self._gates is not None
        table = self.routes.table(index)
        crossings = np.zeros((0, at.CROSSING))
        if len(table):
            most = ABREAST * self.rows[index, at.RADIUS]
            crossings = trace_gates(self._net, *self._gates, most, table)
        if self._crossings.put(index, crossings):
            for other in range(len(self)):
                self._table[other, at.GATE_START] = self._crossings.region(other)[0]
        self.rows[index, [at.GATE_START, at.GATE_COUNT]] = self._crossings.region(index)

    def lead(self, bodies: NDArray[np.float64]) -> None:
        """Bodies that others move and the crowd has to avoid, until the next call: discs (k, 6), see
        `locomotion.crowd.discs`."""
        while len(self._table) < self._count + len(bodies):
            self._double()
        self._led = len(bodies)
        rows = self._table[self._count : self._count + self._led]
        add_discs(rows, self._origin, bodies)

    def foresee(self, graph: navmesh.NodeGraph) -> None:
        """Find the gates of a ``graph`` that is going to be changed to; may be called in another thread."""
        if self._widest > 0.0:
            foresee_gates(graph, ABREAST * self._widest)

    def change_graph(self, graph: navmesh.NodeGraph) -> None:
        """Continue on another graph. All bodies keep their place and their route, whether or not it is still
        valid (`way_left`). A body whose floor is gone, or now more than a step higher or lower, stands
        still and is stuck until a floor comes back.
        """
        shift = self._origin - graph.surface.origin
        cells, floors = project(graph, self.positions)
        self.graph, self._net, self._gates = graph, net_of(graph), None
        self._origin = graph.surface.origin
        self._table[: self._count + self._led, at.X : at.Z + 1] += shift
        self.rows[:, at.GOAL_X : at.GOAL_Z + 1] += shift
        floors -= self._origin[2]
        for index, row in enumerate(self.rows):
            start, count = self.routes.region(index)
            self.routes.rows[start : start + count, :3] += shift
            if cells[index] < 0 or abs(floors[index] - row[at.Z]) > graph.rules.max_step:
                self.walkers[index].lose_ground()
                continue
            row[at.CELL], row[at.Z] = cells[index], floors[index]
            if row[at.MODE] == at.LED:
                row[at.MODE] = at.STANDING
            elif row[at.MODE] == at.WALKING:
                self._lay(index, self.routes.table(index)[int(row[at.NEXT]) - 1 :])

    # --- time
    def tick(self, turns: NDArray[np.bool_] | None = None) -> None:
        """Advance all bodies by `dt`; or only those whose turn it is, ``turns`` (n,): a host that gives each
        body its turn every k-th of its own ticks, some in each, has equally much to do in all of them."""
        if self._count:
            gates = self._gates or self._find_gates()
            advance_all(
                self._net, self._table[: self._count + self._led],
                np.ones(self._count, np.bool_) if turns is None else turns,
                (self.routes.rows, self._crossings.rows), len(gates.width), self.dt,
            )  # fmt: skip
            for index in np.flatnonzero(self.rows[:, at.NOTE] != at.QUIET).tolist():
                self.walkers[index].notice()
