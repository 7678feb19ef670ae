"""What one body makes of a graph: the portals open to it and the typed links on offer, kept for reuse."""

from collections.abc import Mapping
from math import isfinite
from numbers import Real
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from navmesh.errors import NavmeshError
from navmesh.graph.kernel_arrays import door_table, make_doors, net_of
from navmesh.graph.parts import TILE, parts_of_nodes, parts_of_tiles, ways_by_part, with_more_parts
from navmesh.graph.portals import fill_portals, mark_open
from navmesh.obstacles.kinds import affordances
from navmesh.recent import recent
from navmesh.zones.zones import Passages, Zones

if TYPE_CHECKING:
    from navmesh.graph.node_graph import NodeGraph

__all__ = ["checked_radius", "doors_of", "parts_of", "portals_of", "regions_of"]

_NO_LINKS = np.empty(0, np.int64)


def checked_radius(radius: Any) -> float:
    """``radius`` as a float; `NavmeshError` unless it is a finite number above 0."""
    if type(radius) is not float and (isinstance(radius, bool) or not isinstance(radius, Real)):
        raise NavmeshError(f"radius: expected a body's radius [m], a number above 0, not {radius!r}")
    if not isfinite(radius) or radius <= 0.0:
        raise NavmeshError(f"radius = {radius!r}: expected a body's radius [m], above 0")
    return float(radius)


def _checked_skills(skills: Mapping[str, tuple[float, float]] | None) -> tuple:
    """The skills on offer as a sorted tuple (name, least height, greatest height)."""
    if skills is not None and not isinstance(skills, Mapping):
        raise NavmeshError(
            f"skills: expected heights by affordance, as in {{'jump': (0.3, 0.5)}}, not {skills!r}"
        )
    offered = []
    for name, limits in (skills or {}).items():
        if name not in affordances():
            raise NavmeshError(f"skill {name!r}: expected one of {', '.join(affordances())}")
        try:
            low, high = (float(value) for value in limits)
        except (TypeError, ValueError):
            raise NavmeshError(
                f"skill {name!r}: expected (least, greatest height) [m], not {limits!r}"
            ) from None
        if not 0.0 <= low <= high < np.inf:
            raise NavmeshError(f"skill {name!r}: expected 0 <= least <= greatest height [m], not {limits!r}")
        offered.append((name, low, high))
    return tuple(sorted(offered))


class Portals(NamedTuple):
    """The doors open to a body of one radius, in CSR form; see `DOORS`."""

    start: np.ndarray
    """(m + 1,) int32."""
    doors: np.ndarray
    """(p,), as of `door_table`."""
    lens: np.ndarray
    """(p, 2) float64."""
    block: np.ndarray
    """(p, 4) float64."""
    view: np.ndarray
    """(p,) int32: the view of zones that has each, -1 for those that always are there."""


class _Body(NamedTuple):
    """What a body of one radius makes of a graph."""

    portals: Portals
    parts: tuple[np.ndarray, ...]
    passages: Passages | None
    """None where there are no zones."""


def _body_of(graph: "NodeGraph", radius: float) -> _Body:
    """Made once for each radius, and brought to what it is with the zones that are blocked now."""
    body = recent(graph.cache, "bodies", radius, lambda: _body(graph, radius))
    if body.passages is not None:
        body.passages.settle()
    return body


def _body(graph: "NodeGraph", radius: float) -> _Body:
    portals, zones = _portals(graph, radius), graph.zone_state
    target = portals.doors["target"]
    part = parts_of_nodes(portals.start, np.where(portals.view < 0, target, -1).astype(np.int32))
    tiles = parts_of_tiles(net_of(graph), part, radius)
    if zones is None:
        return _Body(portals, (part, *tiles), None)
    passages = Passages(zones, portals.start, portals.view, target)
    passages.join(part)
    tiles = with_more_parts(tiles, *_parts_near_zones(graph, zones, part, radius))
    return _Body(portals, (part, *tiles), passages)


def portals_of(graph: "NodeGraph", radius: float) -> Portals:
    """The doors open to a body of ``radius``; those in blocked zones lead to -1."""
    return _body_of(graph, radius).portals


def _portals(graph: "NodeGraph", radius: float) -> Portals:
    net, zones = net_of(graph), graph.zone_state
    count = len(graph.edge_target)
    source = np.repeat(np.arange(len(graph), dtype=np.int32), np.diff(graph.edge_start))
    view = np.full(count, -1, np.int32) if zones is None else zones.edge_view
    by_view = [np.arange(count)]
    if zones is not None:
        by_view = np.split(np.argsort(view, kind="stable"), np.cumsum(np.bincount(view + 1))[:-1])
    is_open = np.zeros(count, bool)
    for at in [-1] if zones is None else zones.as_divided(graph):
        if at + 1 < len(by_view):
            mark_open(
                net, by_view[at + 1], source, view, graph.edge_width, graph.edge_cells, graph.edge_gate,
                radius, is_open,
            )  # fmt: skip
    opened = int(is_open.sum())
    row = np.cumsum(is_open, dtype=np.int32) - 1
    doors = door_table(opened)
    lens, block = np.empty((opened, 2)), np.full((opened, 4), np.inf)
    for at in [-1] if zones is None else zones.as_divided(graph):
        if at + 1 < len(by_view):
            edges = by_view[at + 1]
            fill_portals(
                net, edges[is_open[edges]], source, row, graph.edge_cells, graph.edge_gate, radius,
                doors["target"], doors["portal"], doors["portal_cell"], lens, block,
            )  # fmt: skip
    start = np.concatenate([[0], np.cumsum(np.bincount(source[is_open], minlength=len(graph)))])
    return Portals(start.astype(np.int32), doors, lens, block, view[is_open])


def _checked_links(graph: "NodeGraph", links: Any) -> np.ndarray:
    """Indices of links (k,) int64, sorted."""
    if isinstance(links, tuple) and not links:  # the default, on every query
        return _NO_LINKS
    index = np.unique(np.asarray(links)) if np.size(links) else np.empty(0, np.int64)
    if index.dtype.kind not in "iu" or (len(index) and not 0 <= index[0] <= index[-1] < len(graph.links)):
        raise NavmeshError(
            f"closed_links: expected indices of the graph's {len(graph.links)} links, not {links!r}"
        )
    return index.astype(np.int64)


def parts_of(graph: "NodeGraph", radius: float) -> tuple[np.ndarray, ...]:
    """The part of each node for a body of ``radius`` with all zones blocked, and the parts in each tile
    (CSR), whatever is blocked, with heights; see `navmesh.graph.parts`."""
    return _body_of(graph, radius).parts


def _parts_near_zones(
    graph: "NodeGraph", zones: Zones, part: np.ndarray, radius: float
) -> tuple[np.ndarray, ...]:
    """In which tiles which parts may be near zones: tiles (k,), parts (k,) and heights (k, 2) [m]."""
    switches, surface = zones.switches, graph.surface
    own_start, cell = switches["own_start"], switches["row_cell"]
    node = np.concatenate([switches["row_label"], switches["own_label"]])
    cell = np.concatenate([cell, np.repeat(cell, np.diff(own_start))])
    wide = (node >= 0) & (switches["node_size"][node] >= radius)
    node, cell = node[wide], cell[wide]
    ix, iy = np.divmod(surface.cell_column[cell], surface.shape[1])
    rise = 0.5 * surface.resolution * np.abs(surface.gradient[cell]).sum(axis=1)
    span = np.column_stack([surface.height[cell] - rise, surface.height[cell] + rise])
    along = (surface.shape[1] + TILE - 1) // TILE
    tiles = []  # a cell can have the nodes of those up to two columns beside it
    for dx, dy in ((-2, -2), (-2, 2), (2, -2), (2, 2)):
        jx, jy = np.clip(ix + dx, 0, surface.shape[0] - 1), np.clip(iy + dy, 0, surface.shape[1] - 1)
        tiles.append(jx // TILE * along + jy // TILE)
    return np.concatenate(tiles), np.tile(part[node], 4), np.tile(span, (4, 1))


def regions_of(graph: "NodeGraph", radius: float) -> np.ndarray:
    """(m,) int32: alike for nodes between which a body of ``radius`` can walk now."""
    body = _body_of(graph, radius)
    return body.parts[0] if body.passages is None else body.passages.region[body.parts[0]]


def _leaps_for(graph: "NodeGraph", radius: float, skills: tuple, closed: np.ndarray) -> dict[str, np.ndarray]:
    """The links on offer but the ``closed`` ones, grouped by the node they start from: the ``leap`` arrays of
    `DOORS`."""
    count = len(graph.radii)
    links = graph.links
    chosen = []
    for name, low, high in skills:
        of_kind = (links.affordance == name) & (links.height >= low) & (links.height <= high)
        chosen.append(np.flatnonzero(of_kind & (links.radius >= radius)))
    index = np.setdiff1d(np.concatenate(chosen), closed) if chosen else np.empty(0, np.int64)
    start_node, end_node = _ends_of_leaps(graph, index)
    index = index[(start_node >= 0) & (end_node >= 0)]
    origin = graph.surface.origin
    start, end = links.start[index] - origin, links.end[index] - origin
    start_cell, end_cell = links.start_cell[index], links.end_cell[index]
    node = _ends_of_leaps(graph, index)[0]
    order = np.lexsort((index, node))
    starts = np.searchsorted(node[order], np.arange(count + 1)).astype(np.int32)
    cost = np.maximum(links.cost[index], np.linalg.norm(end - start, axis=1))
    return {
        "leap_start": starts,
        "leap_id": index[order].astype(np.int32),
        "leap_from": np.ascontiguousarray(start[order]),
        "leap_from_cell": start_cell[order],
        "leap_to": np.ascontiguousarray(end[order]),
        "leap_to_cell": end_cell[order],
        "leap_cost": cost[order],
    }


def _ends_of_leaps(graph: "NodeGraph", index: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The nodes from which and to which links ``index`` (l,) lead, or -1."""
    cells = graph.links.start_cell[index], graph.links.end_cell[index]
    zones = graph.zone_state
    one, other = (graph.label[each] if zones is None else zones.lasting_label(graph, each) for each in cells)
    return one, other


def doors_of(
    graph: "NodeGraph", radius: float, skills: Any, node_costs: np.ndarray | None, closed_links: Any = ()
) -> Any:
    """The `Doors` for a body, made once for each radius, offer of skills and closed links (those with costs
    each time)."""
    offered = _checked_skills(skills) if skills else ()
    closed = _checked_links(graph, closed_links)

    if node_costs is not None:
        doors = _doors(graph, radius, offered, closed, node_costs)
    else:
        key = radius, offered, closed.tobytes()
        doors = recent(graph.cache, "doors", key, lambda: _doors(graph, radius, offered, closed, None))
    if doors.passages is not None:
        doors.passages.settle()
    return doors


def _doors(
    graph: "NodeGraph", radius: float, offered: tuple, closed: np.ndarray, node_costs: np.ndarray | None
) -> Any:
    count = len(graph.radii)
    if node_costs is None:
        costs = np.ones(count)
    else:
        try:
            costs = np.ascontiguousarray(node_costs, dtype=np.float64)
        except (TypeError, ValueError):
            costs = np.empty(0)
        if costs.shape != (count,) or not np.all(costs >= 1.0) or not np.all(np.isfinite(costs)):
            raise NavmeshError(f"node_costs: expected {count} finite factors of at least 1, one per node")
    leaps = _leaps_for(graph, radius, offered, closed)
    portals, (part, tile_start, tile_part, tile_span), passages = _body_of(graph, radius)
    source, target = _ends_of_leaps(graph, leaps["leap_id"])
    if passages is None:
        view, missing, widest = np.full(len(target), -1), np.empty(0, np.int32), float(graph.radii.max())
        region = np.arange(int(part.max(initial=-1)) + 1, dtype=np.int32)
    else:
        zones = passages.zones
        region, missing, widest = passages.region, zones.missing, float(zones.switches["node_size"].max())
        view = np.append(zones.node_view[target], passages.view)
        source, target = np.append(source, passages.source), np.append(target, passages.target)
    part_leap_start, part_leap, part_leap_view = ways_by_part(part, source, target, view)
    parts = {
        "part": part,
        "part_leap_start": part_leap_start,
        "part_leap": part_leap,
        "part_leap_view": part_leap_view,
        "region": region,
        "view_missing": missing,
        "tile_start": tile_start,
        "tile_part": tile_part,
        "tile_span": tile_span,
    }
    doors: Any = make_doors(radius, portals, costs, node_costs is not None, leaps, parts, widest)
    doors.passages = passages
    return doors
