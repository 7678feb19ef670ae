"""Spatial questions to a graph: where is this point, how much room is there, how far does one get.

Every function takes one point (3,) or many (k, 3), in world coordinates [m], and answers with one value or
an array. A point stands for the floor of its column that is nearest in height, at most ``headroom`` away;
beside the outermost cell centres the neighbouring columns are asked too. Points that have no floor are
"off the surface".
"""

from math import isfinite
from numbers import Integral, Real
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from scipy.spatial import KDTree

from navmesh.errors import NavmeshError
from navmesh.graph.kernel_arrays import net_of
from navmesh.graph.open_to_body import regions_of
from navmesh.graph.snapping import roomy_cell
from navmesh.surface.clearance_field import centre_of, floor_at, gap_at, walk
from surefoot.kernels import allocating_kernel, kernel

if TYPE_CHECKING:
    from navmesh.graph.node_graph import NodeGraph

__all__ = [
    "NearestEdge",
    "Ray",
    "cast_ray",
    "clearance_at",
    "containing_node",
    "nearest_edge",
    "nearest_node",
    "project",
    "random_points",
    "reachable_nodes",
    "room_to_turn",
]

_THIN = 1e-3  # [m] radius of a ray that has none: enough to notice what it touches
_MOST_DRAWS = 1000  # rounds of drawing before random_points gives up


class NearestEdge(NamedTuple):
    """The nearest place where walking ends."""

    distance: Any
    """(k,) float64 [m], horizontal; 0 off the surface."""
    place: Any
    """(k, 2) float64 [m], world x and y; nan off the surface."""


class Ray(NamedTuple):
    """How far straight lines over the surface get."""

    clear: Any
    """(k,) bool: whether the end was reached."""
    share: Any
    """(k,) float64, 0 to 1: the part of the line that is free."""
    end: Any
    """(k, 3) float64 [m]: where the free part ends, on the surface; a start off the surface stays."""


@kernel
def _cell_of(net, x, y, z, rise):
    """The cell that (x, y, z) stands for: of its own column, else the nearest of the eight around; or -1."""
    ix = int(np.floor(x / net.cell))
    iy = int(np.floor(y / net.cell))
    best = -1
    least = np.inf
    for ring in range(2):
        for jx in range(max(ix - ring, 0), min(ix + ring + 1, net.nx)):
            for jy in range(max(iy - ring, 0), min(iy + ring + 1, net.ny)):
                column = jx * net.ny + jy
                dx, dy = (jx + 0.5) * net.cell - x, (jy + 0.5) * net.cell - y
                for k in range(net.column_start[column], net.column_start[column + 1]):
                    off = abs(floor_at(net, k, x, y) - z)
                    score = off if ring == 0 else dx * dx + dy * dy
                    if off <= rise and score < least:
                        least = score
                        best = k
        if best >= 0:
            break
    return best


@allocating_kernel
def _project_all(net, points, rise):
    cells = np.empty(points.shape[0], np.int32)
    heights = np.full(points.shape[0], np.nan)
    for i in range(points.shape[0]):
        k = _cell_of(net, points[i, 0], points[i, 1], points[i, 2], rise)
        cells[i] = k
        if k >= 0:
            heights[i] = floor_at(net, k, points[i, 0], points[i, 1])
    return cells, heights


@allocating_kernel
def _gaps(net, points, cells):
    distance = np.zeros(points.shape[0])
    place = np.full((points.shape[0], 2), np.nan)
    for i in range(points.shape[0]):
        if cells[i] >= 0:
            distance[i], place[i, 0], place[i, 1] = gap_at(net, cells[i], points[i, 0], points[i, 1])
    return distance, place


@allocating_kernel
def _cast_all(net, starts, ends, cells, radius):
    clear = np.zeros(starts.shape[0], np.bool_)
    share = np.zeros(starts.shape[0])
    last = np.full(starts.shape[0], -1, np.int32)
    for i in range(starts.shape[0]):
        k = cells[i]
        ax, ay = starts[i, 0], starts[i, 1]
        if k < 0 or gap_at(net, k, ax, ay)[0] < radius:
            continue
        last[i] = k
        dx, dy = ends[i, 0] - ax, ends[i, 1] - ay
        reached, cell, _, place, _, _, _ = walk(net, k, ax, ay, ax + dx, ay + dy, radius, False)
        if reached:
            clear[i], share[i], last[i] = True, 1.0, cell
            continue
        low, high = 0.0, place
        for _ in range(24):
            middle = 0.5 * (low + high)
            reached, cell = walk(net, k, ax, ay, ax + middle * dx, ay + middle * dy, radius, False)[:2]
            if reached:
                low = middle
                last[i] = cell
            else:
                high = middle
        share[i] = low
    return clear, share, last


@allocating_kernel
def _scatter(net, cells, offsets, radius):
    """Points in ``cells`` at ``offsets`` (k, 2), in cells, from their centres; nan where it is too narrow."""
    points = np.full((cells.shape[0], 3), np.nan)
    for i in range(cells.shape[0]):
        x, y = centre_of(net, cells[i])
        x += offsets[i, 0] * net.cell
        y += offsets[i, 1] * net.cell
        # the corner of a cell can lie behind the wall that its centre is in front of
        if (
            walk(
                net, cells[i], x - offsets[i, 0] * net.cell, y - offsets[i, 1] * net.cell, x, y, _THIN, False
            )[0]
            and gap_at(net, cells[i], x, y)[0] >= radius
        ):
            points[i, 0], points[i, 1], points[i, 2] = x, y, floor_at(net, cells[i], x, y)
    return points


@allocating_kernel
def _turns(net, points, cells, reach):
    room = np.zeros(points.shape[0], np.bool_)
    for i in range(points.shape[0]):
        k = cells[i]
        if k >= 0:
            x, y = points[i, 0], points[i, 1]
            room[i] = gap_at(net, k, x, y)[0] >= reach or roomy_cell(net, k, x, y, reach, reach + 1e-9) >= 0
    return room


def _local(graph: "NodeGraph", points: Any, name: str = "points") -> tuple[np.ndarray, bool]:
    """``points`` as (k, 3) relative to the surface's origin, and whether it was one point only."""
    try:
        array = np.asarray(points, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise NavmeshError(f"{name}: expected coordinates (3,) or (k, 3): {error}") from error
    single = array.ndim == 1
    array = array[None] if single else array
    if array.ndim != 2 or array.shape[1] != 3:
        raise NavmeshError(f"{name} have shape {np.shape(points)}, expected (3,) or (k, 3)")
    if not np.isfinite(array).all():
        at = int(np.flatnonzero(~np.isfinite(array).all(axis=1))[0])
        raise NavmeshError(f"{name}: point {at} is not finite: {array[at].tolist()}")
    return np.ascontiguousarray(array - graph.surface.origin), single


def _length(value: Any, name: str) -> float:
    if isinstance(value, bool) or not isinstance(value, Real) or not isfinite(value) or value < 0.0:
        raise NavmeshError(f"{name}: expected a number [m], 0 or more, not {value!r}")
    return float(value)


def _answer(array: np.ndarray, single: bool) -> Any:
    return array[0] if single else array


def project(graph: "NodeGraph", points: Any) -> tuple[Any, Any]:
    """The floor below or above ``points``: (cell int32, world z) of each; (-1, nan) off the surface."""
    local, single = _local(graph, points)
    cells, heights = _project_all(net_of(graph), local, graph.rules.headroom)
    return _answer(cells, single), _answer(heights + graph.surface.origin[2], single)


def nearest_edge(graph: "NodeGraph", points: Any) -> NearestEdge:
    """The nearest place where walking ends, seen from each of ``points``."""
    local, single = _local(graph, points)
    net = net_of(graph)
    cells, _ = _project_all(net, local, graph.rules.headroom)
    distance, place = _gaps(net, local, cells)
    return NearestEdge(_answer(distance, single), _answer(place + graph.surface.origin[:2], single))


def clearance_at(graph: "NodeGraph", points: Any) -> Any:
    """Horizontal distance [m] from each of ``points`` to where walking ends; 0 off the surface."""
    return nearest_edge(graph, points).distance


def nearest_node(graph: "NodeGraph", points: Any) -> Any:
    """The node whose centre is nearest to each of ``points`` in space: int32."""
    local, single = _local(graph, points)
    changes = 0 if graph.zone_state is None else graph.zone_state.changes
    if graph.cache.get("node_tree", (-1,))[0] != changes:
        there = np.flatnonzero(graph.radii >= 0.0).astype(np.int32)
        tree = KDTree(graph.positions[there] - graph.surface.origin)
        graph.cache["node_tree"] = changes, tree, there
    _, tree, there = graph.cache["node_tree"]
    return _answer(there[tree.query(local)[1]], single)


def containing_node(graph: "NodeGraph", points: Any) -> Any:
    """The node that owns the cell of each of ``points``: int32, -1 off the surface and where no body fits."""
    local, single = _local(graph, points)
    cells, _ = _project_all(net_of(graph), local, graph.rules.headroom)
    return _answer(np.where(cells >= 0, graph.label[cells], -1).astype(np.int32), single)


def cast_ray(graph: "NodeGraph", starts: Any, ends: Any, radius: float = 0.0) -> Ray:
    """How far a body of ``radius`` [m] gets from ``starts`` straight towards ``ends``, over the surface.

    Only x and y of the ends count: the line follows the floor, up and down.
    """
    local, single = _local(graph, starts, "starts")
    to, _ = _local(graph, ends, "ends")
    if to.shape != local.shape:
        raise NavmeshError(f"{len(to)} ends for {len(local)} starts: expected as many")
    net = net_of(graph)
    cells, _ = _project_all(net, local, graph.rules.headroom)
    clear, share, last = _cast_all(net, local, to, cells, max(_length(radius, "radius"), _THIN))
    end = local.copy()
    end[:, :2] += share[:, None] * (to - local)[:, :2]
    for i in np.flatnonzero(last >= 0):
        end[i, 2] = floor_at(net, last[i], end[i, 0], end[i, 1])
    return Ray(*(_answer(array, single) for array in (clear, share, end + graph.surface.origin)))


def reachable_nodes(graph: "NodeGraph", start: Any, radius: float = 0.3) -> np.ndarray:
    """The nodes that a body of ``radius`` [m] can walk to from ``start`` (3,): (j,) int32, rising.

    Typed links are not used. Empty when the start is off the surface or in a place too narrow for the body.
    """
    local, single = _local(graph, start, "start")
    if not single and len(local) != 1:
        raise NavmeshError(f"start has shape {np.shape(start)}, expected (3,)")
    node = containing_node(graph, local + graph.surface.origin)
    radius = _length(radius, "radius")
    parts = np.where(graph.radii >= radius, regions_of(graph, radius), -1)
    if node[0] < 0 or parts[node[0]] < 0:
        return np.empty(0, np.int32)
    return np.flatnonzero(parts == parts[node[0]]).astype(np.int32)


def random_points(
    graph: "NodeGraph",
    rng: np.random.Generator,
    count: int,
    radius: float = 0.3,
    reachable_from: Any = None,
) -> np.ndarray:
    """``count`` places (count, 3) [m] where a body of ``radius`` fits, evenly spread seen from above.

    With ``reachable_from`` (3,), only places that it can walk to from there. Raises `NavmeshError` when
    there is no such place.
    """
    if not isinstance(rng, np.random.Generator):
        raise NavmeshError(f"rng: expected a numpy.random.Generator, not {rng!r}")
    if isinstance(count, bool) or not isinstance(count, Integral) or count < 0:
        raise NavmeshError(f"count: expected a whole number, 0 or more, not {count!r}")
    fits = graph.surface.clearance >= _length(radius, "radius") - 0.71 * graph.surface.resolution
    fits &= graph.label >= 0
    if reachable_from is not None:
        allowed = np.zeros(len(graph) + 1, dtype=bool)
        allowed[reachable_nodes(graph, reachable_from, radius)] = True
        fits &= allowed[graph.label]
    cells = np.flatnonzero(fits).astype(np.int32)
    found = np.empty((0, 3))
    net = net_of(graph)
    for _ in range(_MOST_DRAWS if len(cells) else 0):
        drawn = cells[rng.integers(len(cells), size=max(count, 64))]
        points = _scatter(net, drawn, rng.random((len(drawn), 2)) - 0.5, radius)
        found = np.concatenate([found, points[np.isfinite(points[:, 0])]])
        if len(found) >= count:
            return found[:count] + graph.surface.origin
    where = (
        "" if reachable_from is None else f" that it can walk to from {np.asarray(reachable_from).tolist()}"
    )
    raise NavmeshError(f"no place for a body of radius {radius:g} m{where}; expected a smaller radius")


def room_to_turn(graph: "NodeGraph", points: Any, length: float) -> Any:
    """Whether a body of ``length`` [m] can turn around at each of ``points``: bool.

    It can where a free disc of its length lies over the surface around the point: one with a diameter of
    ``length`` whose centre is at most half of that away. Asked of discs around the point and around cells.
    """
    local, single = _local(graph, points)
    net = net_of(graph)
    reach = 0.5 * _length(length, "length")
    if reach > graph.radii.max():
        return _answer(np.zeros(len(local), dtype=bool), single)
    cells, _ = _project_all(net, local, graph.rules.headroom)
    return _answer(_turns(net, local, cells, reach), single)
