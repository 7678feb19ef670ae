"""Dividing a graph at the outlines of zones, once, so that blocking and opening one only says what is there.

The discs of the divided graph are chosen with all zones blocked. They hold whatever is open. What a zone adds
when it is open, its *view*, is found beside that: discs for the cells that are wider then than their disc,
and edges at these cells. Two zones that are next to each other, as the wings of a door, have a view together,
too.
"""

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from navmesh.errors import NavmeshError
from navmesh.graph.edges import measure_edges, rows_of_edges
from navmesh.graph.kernel_arrays import bare_net
from navmesh.graph.nodes import all_nodes, grain_of
from navmesh.surface.ridges import field_of
from navmesh.surface.surface import Surface
from navmesh.zones.lists import Lists, grouped, lists_with, sides_of
from navmesh.zones.outlines import REACH, concerned_by
from navmesh.zones.switching import SWITCHES, turn_all
from navmesh.zones.views import Views
from navmesh.zones.zones import Zones
from surefoot.kernels.bundles import Bundle

if TYPE_CHECKING:
    from navmesh.graph.node_graph import NodeGraph

__all__ = ["NEXT", "Divided", "divide", "divided_graph"]

NEXT = 1.5
"""[m]: zones that are nearer to each other have a view together."""
Arrays = dict[str, np.ndarray]


@dataclass(frozen=True, slots=True, eq=False)
class Divided:
    """A surface and its graph, divided at zones, all of which are blocked."""

    surface: Surface
    node_cell: np.ndarray
    place: np.ndarray
    """(m, 3) float64 [m]: x, y and radius of the nodes, those of views last, in their order."""
    label: np.ndarray
    edges: tuple[np.ndarray, ...]
    """As of `navmesh.graph.edges.join_nodes`."""
    edge_view: np.ndarray
    """(e,) int32: the view that has an edge, -1 for those that always are there."""
    node_view: np.ndarray
    """(m,) int32, alike."""
    zones_of_view: np.ndarray
    """(v, 2) int32: one zone, twice, or two."""
    switches: Arrays
    """The arrays of `navmesh.zones.switching.SWITCHES`, but all_radius."""


class _Known(NamedTuple):
    """Which cells know which zones, by rising cell and zone, and which links these cut."""

    cell: np.ndarray
    zone: np.ndarray
    nearest: np.ndarray
    """(e, 2) float64 [m]: from the cell's centre to the outline."""
    cut: np.ndarray
    """(c, 3) int64: zone, cell and direction."""


def divide(graph: "NodeGraph", outlines: dict[str, np.ndarray], may_be_nowhere: set[str]) -> Divided:
    """The ``graph``, which has no zones, divided at ``outlines`` (k, 3) [m]. Raises `NavmeshError` for a zone
    without any floor, unless it is one of those that ``may_be_nowhere``."""
    surface, least = graph.surface, graph.rules.min_radius
    local = [outline - surface.origin for outline in outlines.values()]
    known = _known(local, list(outlines), surface, 0.5 * graph.rules.headroom, may_be_nowhere)
    sides, side_start = sides_of(local)
    lists = lists_with(surface, known.cell, known.zone, side_start)
    divided = replace(
        surface, link=surface.link.copy(), clearance=surface.clearance.copy(), nearest=surface.nearest.copy(),
        source=lists.source, blocker_start=lists.blocker_start, blocker=lists.blocker,
    )  # fmt: skip
    fixed = _limited(known, divided, len(local)) | _cuts(known, surface, len(local))
    fixed |= _sides(lists, sides, side_start)
    fixed |= {
        "blocked": np.zeros(len(local), np.int32), "all_link": divided.link,
        "all_clearance": divided.clearance, "all_nearest": divided.nearest, "all_blocker": divided.blocker,
    }  # fmt: skip
    fixed["row_label"] = np.full(len(fixed["row_cell"]), -1, np.int32)
    fixed["all_label"] = np.full(len(surface), -1, np.int32)
    nothing = np.empty((0, 2), np.int32)
    every = np.arange(len(local), dtype=np.int32)
    _Turning(fixed | _of_views(None, nothing, fixed), divided).turn(every, 1)
    field = field_of(divided)
    node_cell, place, _, fixed["all_label"] = all_nodes(divided, field, least)
    fixed["row_label"] = fixed["all_label"][fixed["row_cell"]]
    views = Views(fixed["all_label"], node_cell, place, measure_edges(fixed["all_label"], field, place))
    alone = np.column_stack([every, every])
    together = _next_to_each_other(fixed)
    for found, wanted in ((nothing, alone), (alone, together)):
        turning = _Turning(fixed | _of_views(views, found, fixed), divided)
        for zones in wanted:
            turning.turn(zones, 0)
            rows = _rows_of(fixed, zones)
            views.find(rows, fixed["row_cell"][rows], field, least, grain_of(divided))
            turning.turn(zones, 1)
    return _assembled(views, np.concatenate([alone, together]), fixed, divided)


def _known(
    outlines: list[np.ndarray], names: list[str], surface: Surface, rise: float, may_be_nowhere: set[str]
) -> _Known:
    mark = np.zeros(len(surface), np.int32)
    cells, nearest, zones, cut = [], [], [], []
    for i, outline in enumerate(outlines):
        found = concerned_by(outline, surface, rise, mark, i + 1)
        if not len(found.cell) and names[i] not in may_be_nowhere:
            raise NavmeshError(
                f"zone {names[i]!r}: expected an outline on the floor, which there is not within "
                f"{rise:g} m of its height"
            )
        cells.append(found.cell)
        nearest.append(found.nearest)
        zones.append(np.full(len(found.cell), i, np.int32))
        cut.append(np.column_stack([np.full(len(found.cut), i), found.cut]).astype(np.int64))
    cell, zone = np.concatenate(cells), np.concatenate(zones)
    order = np.lexsort((zone, cell))
    return _Known(cell[order], zone[order], np.concatenate(nearest)[order], np.concatenate(cut))


def _limited(known: _Known, divided: Surface, zones: int) -> Arrays:
    """What is far from zones is put to what it is when they are blocked; the rest becomes the rows."""
    far = np.hypot(*known.nearest.T)
    away = np.flatnonzero((far > REACH) & (far < divided.clearance[known.cell]))
    away = away[np.lexsort((far[away], known.cell[away]))]
    cell, first = np.unique(known.cell[away], return_index=True)
    divided.clearance[cell] = far[away[first]]
    divided.nearest[cell] = known.nearest[away[first]]
    near = np.flatnonzero(far <= REACH)
    row_cell, row = np.unique(known.cell[near], return_inverse=True)
    zone = known.zone[near]
    near_start, near_zone, vector = grouped(row, len(row_cell), zone, known.nearest[near])
    cell_start, cell_row = grouped(zone, zones, row.astype(np.int32))
    return {
        "row_cell": row_cell.astype(np.int32), "row_nearest": divided.nearest[row_cell],
        "near_start": near_start, "near_zone": near_zone, "near": vector,
        "cell_start": cell_start, "cell_row": cell_row,
    }  # fmt: skip


def _cuts(known: _Known, surface: Surface, zones: int) -> Arrays:
    zone, cell, way = known.cut.T
    link, at = np.unique(cell * 4 + way, return_inverse=True)
    cut_start, cut_link = grouped(zone, zones, at.astype(np.int32))
    to = surface.link[link // 4, link % 4]
    return {
        "cut_start": cut_start, "cut_link": cut_link,
        "cut": np.column_stack([link // 4, link % 4, to]).astype(np.int32).reshape(-1, 3),
        "cut_count": np.zeros(len(link), np.int32),
    }  # fmt: skip


def _sides(lists: Lists, sides: np.ndarray, side_start: np.ndarray) -> Arrays:
    zone = np.searchsorted(side_start, lists.side, side="right") - 1
    start, row, side = grouped(zone, len(side_start) - 1, lists.row, lists.side)
    return {"side_start": start, "side_row": row, "side": np.ascontiguousarray(sides[side])}


def _of_views(views: Views | None, zones_of_view: np.ndarray, fixed: Arrays) -> Arrays:
    """The arrays of the views found so far, with all zones blocked."""
    count = len(zones_of_view)
    zones = len(fixed["cell_start"]) - 1
    numbers = np.arange(count, dtype=np.int32)
    two = zones_of_view[:, 0] != zones_of_view[:, 1]
    of_zone = np.concatenate([zones_of_view[:, 0], zones_of_view[two, 1]])
    view_start, view = grouped(of_zone, zones, np.concatenate([numbers, numbers[two]]))
    own = [] if views is None else views.own
    row, label = (np.concatenate([np.empty(0, np.int32), *(each[k] for each in own)]) for k in range(2))
    own_view = np.repeat(np.arange(-1, len(own) - 1, dtype=np.int32), [len(each[0]) for each in own])
    own_start, own_view, own_label = grouped(row, len(fixed["row_cell"]), own_view, label)
    first = np.zeros(1) if views is None else np.array(views.first)
    return {
        "view_start": view_start, "zone_view": view, "view_missing": (1 + two).astype(np.int32),
        "view_node": first.astype(np.int32), "own_start": own_start, "own_view": own_view,
        "own_label": own_label, "node_size": np.empty(0) if views is None else views.size,
    }  # fmt: skip


class _Turning:
    """Blocks and opens zones while there is no graph yet."""

    def __init__(self, switches: Arrays, divided: Surface) -> None:
        nodes = len(switches["node_size"])
        self._net = bare_net(divided, nodes)
        self._switches = Bundle(SWITCHES, **switches, all_radius=np.empty(nodes))

    def turn(self, zones: np.ndarray, blocked: int) -> None:
        turn_all(self._switches, self._net, zones, np.full(len(zones), blocked, np.int32))


def _rows_of(fixed: Arrays, zones: np.ndarray) -> np.ndarray:
    """The rows near both of two zones."""
    one, other = (fixed["cell_row"][fixed["cell_start"][z] : fixed["cell_start"][z + 1]] for z in zones)
    return one if zones[0] == zones[1] else np.intersect1d(one, other)


def _next_to_each_other(fixed: Arrays) -> np.ndarray:
    """(p, 2) int32: pairs of zones with a cell between them that is less than `NEXT` from both together."""
    row = np.repeat(np.arange(len(fixed["row_cell"])), np.diff(fixed["near_start"]))
    far = np.hypot(*fixed["near"].T)
    zone = fixed["near_zone"]
    pairs = [np.empty((0, 2), np.int32)]
    for step in range(1, int(np.diff(fixed["near_start"]).max(initial=0))):
        close = (row[step:] == row[:-step]) & (far[step:] + far[:-step] < NEXT)
        pairs.append(np.unique(np.column_stack([zone[:-step], zone[step:]])[close], axis=0))
    return np.unique(np.concatenate(pairs), axis=0)


def _assembled(views: Views, zones_of_view: np.ndarray, fixed: Arrays, divided: Surface) -> Divided:
    view = np.repeat(
        np.arange(-1, len(zones_of_view), dtype=np.int32), [len(each[1]) for each in views.edges]
    )
    ends, width, gate, pair = (np.concatenate(column) for column in zip(*views.edges, strict=True))
    order = np.lexsort((view, ends[:, 1], ends[:, 0]))
    ends, width, gate, pair, view = (np.ascontiguousarray(a[order]) for a in (ends, width, gate, pair, view))
    edges = rows_of_edges(views.count, ends, width, gate, pair)
    edge_view = rows_of_edges(views.count, ends, view.astype(np.float64), gate, pair)[2].astype(np.int32)
    first = np.diff(np.array([0, *views.first]))
    return Divided(
        surface=divided, node_cell=views.node_cell[: views.count].copy(),
        place=views.place[: views.count].copy(), label=fixed["all_label"], edges=edges, edge_view=edge_view,
        node_view=np.repeat(np.arange(-1, len(zones_of_view), dtype=np.int32), first),
        zones_of_view=zones_of_view, switches=fixed | _of_views(views, zones_of_view, fixed),
    )  # fmt: skip


def divided_graph(
    graph: "NodeGraph", outlines: dict[str, np.ndarray], may_be_nowhere: set[str], blocked: np.ndarray
) -> "NodeGraph":
    """The ``graph``, which has no zones, with those of ``outlines``, of which some are ``blocked`` (z,); see
    `divide`."""
    if not outlines:
        return graph
    made = divide(graph, outlines, may_be_nowhere)
    start, target, width, gate, border = made.edges
    radii = np.where(made.node_view < 0, made.place[:, 2], -1.0)
    zones = Zones(
        outlines, graph, made.node_view, made.edge_view, made.zones_of_view,
        made.switches | {"all_radius": radii},
    )  # fmt: skip
    divided = replace(
        graph, surface=made.surface, positions=made.surface.lifted(made.place[:, :2], made.node_cell),
        radii=radii, node_cell=made.node_cell, label=made.label, edge_start=start, edge_target=target,
        edge_width=width, edge_gate=gate, edge_cells=border, zone_state=zones, cache={},
    )  # fmt: skip
    zones.turn_to(divided, blocked)
    return divided
