"""What zones have to do with a graph, found once, so that blocking and opening one looks near it only."""

from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from scipy.spatial import KDTree

from navmesh.errors import NavmeshError
from navmesh.graph.nodes import grain_of
from navmesh.grouping import grouped
from navmesh.surface.storeys import linked
from navmesh.surface.surface import Surface
from navmesh.zones.distances import segments_to_outline
from navmesh.zones.kept_pieces import room_for_states
from navmesh.zones.leaps import links_near
from navmesh.zones.lists import lists_with, sides_of
from navmesh.zones.outlines import Concerned, concerned_by
from surefoot.kernels import allocating_kernel

if TYPE_CHECKING:
    from navmesh.graph.node_graph import NodeGraph

__all__ = ["Divided", "divide"]

Arrays = dict[str, np.ndarray]
_TOUCH = 1e-9  # [m]
_COLUMNS = 5
"""Cells beyond twice a disc's radius at which its cells, and those beside them, can know of a zone."""
_STEPS = 4
"""Links from a cell to those whose lists its disc's place follows from: it is looked for in cells up to a
corner away, and these ask theirs (`navmesh.surface.ridges.middle_beside`)."""
_SIDEWAYS = 4.2
"""Times its radius that an edge of a disc, or of a piece of it, can reach sideways from its centre: its
radius to the piece's centre, as much to the portal's middle, and from there to its end, and a body's radius
on."""


class Divided(NamedTuple):
    """A graph with room for pieces of the discs that zones can be in the way of."""

    surface: Surface
    """With arrays of its own where zones change them."""
    switches: dict
    """The fields of `navmesh.zones.switches.SWITCHES` but those of slots and of nodes."""
    user_near: tuple[np.ndarray, np.ndarray]
    """By zone, as start (z + 1,) and values: the discs whose edges, or those of whose pieces, it may
    narrow."""
    bound: np.ndarray
    """(z,) int64: how many slots more there may be after a zone has been blocked or opened."""
    fringe: np.ndarray
    """(f,) int32: the nodes that are never broken beside those that can be."""
    links: tuple[np.ndarray, np.ndarray, np.ndarray]
    """The links that zones can close, see `links_near`."""


def divide(graph: "NodeGraph", outlines: dict[str, np.ndarray], may_be_nowhere: set[str]) -> Divided:
    """What ``outlines`` (k, 3) [m] have to do with a ``graph`` without zones. Raises `NavmeshError` for a
    zone without any floor or link, unless it is one of those that ``may_be_nowhere``."""
    surface = graph.surface
    local = [outline - surface.origin for outline in outlines.values()]
    links = links_near(graph, list(outlines.values()))
    of_links = {name for number, name in enumerate(outlines) if (links[0] == number).any()}
    found = _concerned(local, list(outlines), graph, may_be_nowhere | of_links)
    zone = np.repeat(np.arange(len(local), dtype=np.int32), [len(each.cell) for each in found])
    cell = np.concatenate([each.cell for each in found])
    vector = np.concatenate([each.nearest for each in found])
    order = np.lexsort((zone, cell))
    known_cell, known = np.unique(cell, return_inverse=True)
    near_start, near_zone, near = grouped(known[order], len(known_cell), zone[order], vector[order])
    cell_start, cell_known = grouped(zone, len(local), known.astype(np.int32))
    sides, side_start = sides_of(local)
    lists = lists_with(surface, cell[order], zone[order], side_start)
    nearest = surface.nearest
    divided = replace(
        surface, storey=surface.storey.copy(), clearance=surface.clearance.copy(), kept_nearest=nearest,
        source=lists.source, list_start=lists.list_start, blocker=lists.blocker,
    )  # fmt: skip
    side_zone = np.searchsorted(side_start, lists.side, side="right") - 1
    row_start, row, side = grouped(side_zone, len(local), lists.row, lists.side)
    switches = {
        "grain": grain_of(surface), "least": graph.rules.min_radius, "first_piece": len(graph),
        "blocked": np.zeros(len(local), np.int32), "cell_start": cell_start, "cell_known": cell_known,
        "known_cell": known_cell.astype(np.int32), "known_nearest": nearest[known_cell],
        "known_clearance": surface.clearance[known_cell],
        "near_start": near_start, "near_zone": near_zone, "near": near,
        "side_start": row_start, "side_row": row, "side": np.ascontiguousarray(sides[side]),
        "origin": np.ascontiguousarray(surface.origin, np.float64), "all_storey": divided.storey,
        "all_clearance": divided.clearance, "all_nearest": nearest, "all_blocker": divided.blocker,
    }  # fmt: skip
    users = _users(graph, local, found)
    switches |= _cuts(found, surface) | users
    near_nodes, near_users = _near(graph, local, users)
    signs = np.random.default_rng(0).integers(-(2**63), 2**63, len(local), np.int64)
    switches |= {"around_start": near_nodes[0], "around": near_nodes[1], "zone_sign": signs}
    rows = np.diff(users["row_start"])[users["user"]]
    bound = np.add.reduceat(np.append(8 * rows, 0), users["user_start"][:-1]).astype(np.int64)
    bound[np.diff(users["user_start"]) == 0] = 0
    beside = surface.links(users["row_cell"]).ravel()
    owner = graph.label[beside[beside >= 0]]
    fringe = np.setdiff1d(owner[owner >= 0], users["whole"]).astype(np.int32)
    return Divided(divided, switches, near_users, bound, fringe, links)


def _concerned(
    outlines: list[np.ndarray], names: list[str], graph: "NodeGraph", may_be_nowhere: set[str]
) -> list[Concerned]:
    mark = np.zeros(len(graph.surface), np.int32)
    rise = 0.5 * graph.rules.headroom
    found = [concerned_by(outline, graph.surface, rise, mark, i + 1) for i, outline in enumerate(outlines)]
    for name, each in zip(names, found, strict=True):
        if not len(each.cell) and name not in may_be_nowhere:
            raise NavmeshError(
                f"zone {name!r}: expected an outline on the floor, but there is none within {rise:g} m "
                f"above or below it"
            )
    return found


def _cuts(found: list[Concerned], surface: Surface) -> Arrays:
    zone = np.repeat(np.arange(len(found)), [len(each.cut) for each in found])
    cell, way = np.concatenate([each.cut for each in found]).astype(np.int64).T
    link, at = np.unique(cell * 4 + way, return_inverse=True)
    cut_start, cut_link = grouped(zone, len(found), at.astype(np.int32))
    to = surface.storey[link // 4, link % 4]
    return {
        "cut_start": cut_start, "cut_link": cut_link,
        "cut": np.column_stack([link // 4, link % 4, to]).astype(np.int32).reshape(-1, 3),
        "cut_count": np.zeros(len(link), np.int32),
    }  # fmt: skip


def _users(graph: "NodeGraph", outlines: list[np.ndarray], found: list[Concerned]) -> Arrays:
    """The discs that zones have to do with, and the cells of these discs."""
    place = graph.positions[:, :2] - graph.surface.origin[:2]
    source = np.repeat(np.arange(len(graph)), np.diff(graph.edge_start))
    node_start, node_at = grouped(graph.node_cell, len(graph.label), np.arange(len(graph)))
    edge_start, edge_at = grouped(graph.edge_cells[:, 0], len(graph.label), np.arange(len(source)))
    cut, follow, mark = [], [], np.zeros(len(graph.label), np.int32)
    field = graph.surface.field
    for outline, each in zip(outlines, found, strict=True):
        flat = np.ascontiguousarray(outline[:, :2])
        nodes = _listed(node_start, node_at, each.cell)
        away = segments_to_outline(flat, np.column_stack([place[nodes], place[nodes]]))
        inside = nodes[away < graph.radii[nodes] - _TOUCH]
        edges = _listed(edge_start, edge_at, each.cell)
        ends = np.concatenate([source[edges], graph.edge_target[edges]])
        gate, width = np.tile(graph.edge_gate[edges], (2, 1)), np.tile(graph.edge_width[edges], 2)
        way = segments_to_outline(flat, np.column_stack([place[ends], gate]))
        cut.append(np.union1d(inside, ends[way < width - _TOUCH]))
        number = len(follow) + 1
        owner = np.unique(graph.label[_linked(field, each.cell, _STEPS, mark, number)])
        follow.append(np.union1d(owner[owner >= 0], cut[-1]))
    whole = np.unique(np.concatenate(cut)).astype(np.int32)
    follow = [each[np.isin(each, whole)] for each in follow]
    is_cut = [np.isin(each, those) for each, those in zip(follow, cut, strict=True)]
    number = np.full(len(graph) + 1, -1, np.int32)
    number[whole] = np.arange(len(whole))
    owner = number[graph.label]
    cells = np.flatnonzero(owner >= 0)
    row_start, row_cell = grouped(owner[cells], len(whole), cells.astype(np.int32))
    cell_row = np.full(len(graph.label), -1, np.int32)
    cell_row[row_cell] = np.arange(len(row_cell))
    row_user = np.repeat(np.arange(len(whole), dtype=np.int32), np.diff(row_start))
    beside = graph.surface.links(row_cell)
    row, way = np.nonzero((beside >= 0) & (owner[beside] != row_user[:, None]))
    rim = np.column_stack([row_cell[row], way, beside[row, way]]).astype(np.int32)
    rim_start, rim = grouped(row_user[row], len(whole), rim)
    user_start = np.cumsum([0, *map(len, follow)]).astype(np.int32)
    user = number[np.concatenate(follow).astype(np.int64)]
    return room_for_states(user_start, user, row_start) | {
        "user_start": user_start, "user": user,
        "user_cut": np.concatenate(is_cut).astype(np.int32), "whole": whole,
        "whole_radius": graph.radii[whole], "broken": np.zeros(len(whole), np.int32),
        "turned": np.zeros(len(whole), np.int64), "row_start": row_start, "row_cell": row_cell,
        "row_user": row_user, "row_power": np.empty(len(row_cell)), "cell_row": cell_row,
        "piece_count": np.zeros(len(whole), np.int32), "piece": np.empty(len(row_cell), np.int32),
        "rim_start": rim_start, "rim": rim,
    }  # fmt: skip


@allocating_kernel
def _linked(field, cells, steps, mark, number):
    """``cells`` (k,), and those that up to so many ``steps`` over links lead to. ``mark`` (n,) int32 are
    notes of which cells have been come to for which ``number``, above 0."""
    found = np.empty(2 * cells.size + 64, np.int32)
    found[: cells.size] = cells
    mark[cells] = number
    first, count = 0, cells.size
    for _ in range(steps):
        last = count
        for i in range(first, last):
            for d in range(4):
                other = linked(field, found[i], d)
                if other < 0 or mark[other] == number:
                    continue
                if count == found.size:
                    found = np.concatenate((found, np.empty_like(found)))
                mark[other] = number
                found[count] = other
                count += 1
        first = last
    return found[:count].copy()


def _listed(start: np.ndarray, values: np.ndarray, groups: np.ndarray) -> np.ndarray:
    """The ``values`` of some ``groups``, which begin at ``start``."""
    size = start[groups + 1] - start[groups]
    at = np.repeat(start[groups] - np.cumsum(size) + size, size) + np.arange(size.sum())
    return values[at]


def _near(graph: "NodeGraph", outlines: list[np.ndarray], users: Arrays) -> tuple:
    """By zone: the nodes that it has to do with or whose edges reach it, with those beside these; and which
    of the discs that can be broken these are."""
    place, radii = graph.positions[:, :2] - graph.surface.origin[:2], graph.radii
    size = np.floor(np.log2(np.maximum(radii, 1e-3))).astype(np.int64)  # trees of discs of about one size
    trees = [(KDTree(place[size == k]), np.flatnonzero(size == k), 2.0 ** (k + 1)) for k in np.unique(size)]
    number = np.full(len(graph), -1, np.int32)
    number[users["whole"]] = np.arange(len(users["whole"]))
    nodes, near, wide = [], [], _COLUMNS * graph.surface.resolution
    beside_disc: dict[int, np.ndarray] = {}

    def lines_near(user: int) -> np.ndarray:
        """The nodes whose lines are measured in pieces of a disc where that is broken: its cells get other
        discs."""
        those = [
            its[tree.query_ball_point(place[user], radii[user] + _SIDEWAYS * most + wide)]
            for tree, its, most in trees
        ]
        those = np.concatenate(those).astype(np.int64)
        off = np.hypot(*(place[those] - place[user]).T) - radii[user]
        return those[off < np.maximum(_SIDEWAYS * radii[those], 2.0 * radii[those] + wide)]

    for zone, outline in enumerate(outlines):
        flat = np.ascontiguousarray(outline[:, :2])
        middle = flat.mean(axis=0)
        reach = np.hypot(*(flat - middle).T).max()
        close = [
            those[tree.query_ball_point(middle, reach + _SIDEWAYS * most + wide)]
            for tree, those, most in trees
        ]
        close = np.concatenate(close).astype(np.int64)
        away = segments_to_outline(flat, np.column_stack([place[close], place[close]]))
        close = close[away < np.maximum(_SIDEWAYS * radii[close], 2.0 * radii[close] + wide)]
        own = users["whole"][users["user"][users["user_start"][zone] : users["user_start"][zone + 1]]]
        for user in own.tolist():
            if user not in beside_disc:
                beside_disc[user] = lines_near(user)
        close = np.unique(np.concatenate([close, own, *(beside_disc[user] for user in own.tolist())]))
        beside = _listed(graph.edge_start, graph.edge_target, close)
        nodes.append(np.union1d(close, beside).astype(np.int32))
        near.append(number[nodes[-1]][number[nodes[-1]] >= 0])
    return _rows(nodes), _rows(near)


def _rows(values: list[np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
    return np.cumsum([0, *map(len, values)]).astype(np.int32), np.concatenate(values).astype(np.int32)
