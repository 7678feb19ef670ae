"""What one body makes of a graph: the portals open to it and the typed links on offer, kept for reuse."""

from collections.abc import Mapping
from math import isfinite
from numbers import Real
from typing import TYPE_CHECKING, Any

import numpy as np

from navmesh.errors import NavmeshError
from navmesh.graph.kernel_arrays import make_doors, tile_fields
from navmesh.graph.part_changes import tiles_for
from navmesh.graph.parts import Tiles, parts_of_nodes
from navmesh.graph.portal_changes import portals_for
from navmesh.grouping import by_group
from navmesh.obstacles.kinds import affordances
from navmesh.recent import recent
from navmesh.zones.bodies import zoned_body
from navmesh.zones.leaps import settle_leaps

if TYPE_CHECKING:
    from navmesh.graph.node_graph import NodeGraph

__all__ = ["checked_radius", "checked_skills", "doors_of", "parts_of", "portals_of", "regions_of"]


def checked_radius(radius: Any) -> float:
    """``radius`` as a float; `NavmeshError` unless it is a finite number above 0."""
    if type(radius) is not float and (isinstance(radius, bool) or not isinstance(radius, Real)):
        raise NavmeshError(f"radius: expected a body's radius [m], a number above 0, not {radius!r}")
    if not isfinite(radius) or radius <= 0.0:
        raise NavmeshError(f"radius = {radius!r}: expected a body's radius [m], above 0")
    return float(radius)


def checked_skills(skills: Mapping[str, tuple[float, float]] | None) -> tuple:
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


def portals_of(graph: "NodeGraph", radius: float) -> tuple[np.ndarray, ...]:
    """The doors open to a body of ``radius`` in CSR form: start (m + 1,), doors (p,) as of `door_rows`, lens
    (p, 2), block (p, 4); see `DOORS`."""
    return recent(graph.cache, "portals", radius, lambda: portals_for(graph, radius))


def _checked_costs(graph: "NodeGraph", costs: Any) -> np.ndarray | None:
    """Costs of the graph's links (l,) float64 [m]; None stays None."""
    if costs is None:
        return None
    try:
        checked = np.ascontiguousarray(costs, dtype=np.float64)
    except (TypeError, ValueError):
        checked = np.empty(0)
    count = len(graph.links)
    if checked.shape != (count,) or not np.all(checked >= 0.0):
        raise NavmeshError(f"link_costs: expected {count} costs [m] of at least 0, one for each link")
    return checked


def parts_of(graph: "NodeGraph", radius: float) -> tuple[np.ndarray, Tiles]:
    """The part of each node for a body of ``radius``, and the parts in each tile."""

    def make() -> tuple[np.ndarray, Tiles]:
        start, doors = portals_of(graph, radius)[:2]
        part = parts_of_nodes(start, np.ascontiguousarray(doors["target"]))
        return part, tiles_for(graph, part, radius)

    return recent(graph.cache, "parts", radius, make)


def regions_of(graph: "NodeGraph", radius: float) -> np.ndarray:
    """(m,) int32: alike for nodes between which a body of ``radius`` can walk, with the zones that are open
    now."""
    zones = graph.zone_state
    if zones is None:
        return parts_of(graph, radius)[0]
    with zones.lock:
        body = zoned_body(graph, radius)
        return body.region[body.part]


def _leaps_for(
    graph: "NodeGraph", radius: float, skills: tuple, link_costs: np.ndarray | None
) -> dict[str, np.ndarray]:
    """The links on offer, grouped by the node they start from: the ``leap`` arrays of `DOORS`. ``link_costs``
    come on top of their own."""
    zones = graph.zone_state
    undivided = graph if zones is None else zones.undivided
    count, label, links = len(undivided), undivided.label, graph.links
    chosen = []
    for name, low, high in skills:
        of_kind = (links.affordance == name) & (links.height >= low) & (links.height <= high)
        chosen.append(np.flatnonzero(of_kind & (links.radius >= radius)))
    index = np.unique(np.concatenate(chosen)) if chosen else np.empty(0, np.int64)
    if link_costs is not None:
        index = index[np.isfinite(link_costs[index])]
    index = index[(label[links.start_cell[index]] >= 0) & (label[links.end_cell[index]] >= 0)]
    origin = graph.surface.origin
    start, end = links.start[index] - origin, links.end[index] - origin
    start_cell, end_cell = links.start_cell[index], links.end_cell[index]
    node = label[start_cell]
    order = np.lexsort((index, node))
    starts = np.searchsorted(node[order], np.arange(count + 1)).astype(np.int32)
    cost = np.maximum(links.cost[index], np.linalg.norm(end - start, axis=1))
    if link_costs is not None:
        cost += link_costs[index]
    return {
        "leap_start": starts,
        "leap_id": index[order].astype(np.int32),
        "leap_from": np.ascontiguousarray(start[order]),
        "leap_from_cell": start_cell[order],
        "leap_to": np.ascontiguousarray(end[order]),
        "leap_to_cell": end_cell[order],
        "leap_cost": cost[order],
        "leap_closed": np.zeros(len(order), np.int32),
        "leap_node": node[order],
    }


def doors_of(
    graph: "NodeGraph",
    radius: float,
    skills: Any,
    node_costs: np.ndarray | None,
    link_costs: Any = None,
) -> Any:
    """The `Doors` for a body, made once for each radius, offer of skills and costs of links (those with costs
    of nodes each time)."""
    offered = checked_skills(skills) if skills else ()
    priced = _checked_costs(graph, link_costs)
    offer = offered, None if priced is None else priced.tobytes()

    def make() -> Any:
        return _doors(graph, radius, _leaps_for(graph, radius, offered, priced), node_costs)

    zones = graph.zone_state
    if zones is None:
        if node_costs is not None:
            return make()
        return recent(graph.cache, "doors", (radius, *offer), make)
    with zones.lock:
        zoned_body(graph, radius)
        key = radius, *offer, zones.slots
        doors = make() if node_costs is not None else recent(graph.cache, "doors", key, make)
        settle_leaps(zones, doors)
        return doors


def _doors(
    graph: "NodeGraph", radius: float, leaps: dict[str, np.ndarray], node_costs: np.ndarray | None
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
    weighted = node_costs is not None
    if graph.zone_state is not None:
        return zoned_body(graph, radius).doors(leaps, costs, weighted)
    part, tiles = parts_of(graph, radius)
    every = np.arange(int(part.max(initial=-1)) + 1, dtype=np.int32)
    part_leap_start, part_leap = by_group(part[leaps.pop("leap_node")], len(every))
    leaps["whole"] = np.arange(count, dtype=np.int32)
    parts = {
        "part": part,
        "region": every,
        "ring": every,
        "part_whole": every,
        "anywhere": -1,
        "part_leap_start": part_leap_start,
        "part_leap": part_leap,
    }
    parts |= tile_fields(tiles, len(every))
    return make_doors(
        radius, portals_of(graph, radius), costs, weighted, leaps, parts, float(graph.radii.max())
    )
