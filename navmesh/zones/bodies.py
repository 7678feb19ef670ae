"""What a body of one radius makes of a graph with zones, kept up to date as these are blocked and opened."""

from typing import TYPE_CHECKING, Any

import numpy as np

from navmesh.graph.kernel_arrays import door_rows, make_doors, net_of, tile_fields
from navmesh.graph.parts import parts_in_tiles, parts_of_nodes, parts_of_tiles
from navmesh.graph.portals import open_portals
from navmesh.grouping import by_group, grouped
from navmesh.recent import recent
from navmesh.zones.memo import nothing_kept
from navmesh.zones.settling import count_reached, join_regions, settle_doors
from navmesh.zones.zones import Zones, zones_of

if TYPE_CHECKING:
    from navmesh.graph.node_graph import NodeGraph

__all__ = ["ZonedBody", "zoned_body"]

_KEPT = 512  # doors for each zone


class ZonedBody:
    """The doors of one body radius, and what they join."""

    def __init__(self, graph: "NodeGraph", zones: Zones, radius: float) -> None:
        self.radius = radius
        self._zones = zones
        self._net = net_of(graph)
        base = zones.undivided
        net = net_of(base)
        widths = base.edge_width, base.edge_cells, base.edge_gate
        start, target, *rows = open_portals(net, *widths, radius)
        self._base_target = target
        source = np.repeat(np.arange(len(base)), np.diff(start))
        all_source = np.repeat(np.arange(len(base)), np.diff(base.edge_start))
        key = (all_source.astype(np.int64) << 32) | base.edge_target
        self._base_edge = np.searchsorted(key, (source.astype(np.int64) << 32) | target).astype(np.int32)
        self._edges = base.edge_cells, base.edge_gate
        pieces = len(graph) - len(base)
        self._start = np.concatenate([start, np.full(pieces, start[-1], np.int32)])
        self._base_rows = tuple(rows)
        self._reached = np.zeros(len(target), np.int32)
        self._counted = np.zeros(len(zones.outlines), np.int32)
        self._rows = target.copy(), *rows
        self._with_slots()
        self._parts(net, start)
        self._settled = -1
        keys = nothing_kept(_KEPT * len(zones.outlines))
        self._kept = keys, np.empty((len(keys), 12)), np.empty((len(keys), 3), np.int32)

    def _with_slots(self) -> None:
        """Make room for the slots of the zones; their doors are as they were."""
        slots, count = self._zones.slots, len(self._base_target)
        target, portal, cells, lens, block = (_with_rows(each, count + slots) for each in self._rows)
        self._doors, self._lens, self._block = door_rows(target, portal, cells), lens, block
        self._rows = self._doors["target"], self._doors["portal"], self._doors["portal_cell"], lens, block
        self.slots = slots
        self._bare = None

    def _parts(self, net: Any, start: np.ndarray) -> None:
        """Parts with all discs that can be broken, and their pieces, by themselves; and one more, that stands
        for these in tiles."""
        base, switches = self._zones.undivided, self._zones.switches
        whole = switches.whole
        loose = np.zeros(len(base), bool)
        loose[whole] = True
        source = np.repeat(np.arange(len(base)), np.diff(start))
        target = np.where(loose[source] | loose[self._base_target], -1, self._base_target)
        part = parts_of_nodes(self._start, target.astype(np.int32))
        self.part = part
        self._anywhere = count = int(part.max(initial=-1)) + 1
        self.region = np.arange(count + 1, dtype=np.int32)
        self.ring = self.region.copy()
        self.whole = np.arange(len(part), dtype=np.int32)
        self.whole[len(base) :] = whole[switches.row_user]
        self._part_whole = self.region.copy()
        self._part_whole[part[len(base) :]] = part[self.whole[len(base) :]]
        number = np.zeros(len(base), np.int64)
        number[whole] = np.arange(len(whole))
        leaving = np.flatnonzero(loose[source])
        ends = number[source[leaving]], part[self._base_target[leaving]]
        ways = np.unique(np.column_stack(ends), axis=0, return_index=True)[1]
        self.ways = grouped(ends[0][ways], len(whole), self._base_target[leaving[ways]])
        of_tiles = np.where(loose, count, part[: len(base)]).astype(np.int32)
        tiles = parts_of_tiles(net, of_tiles, self.radius)
        cells = np.union1d(switches.known_cell, switches.row_cell)
        self._tiles = parts_in_tiles(tiles, base.surface, cells, count)

    def settle(self) -> None:
        """Bring all to what it is with the zones that are blocked now."""
        zones = self._zones
        if self.slots != zones.slots:
            self._with_slots()
        if self._settled == zones.changes:
            return
        if self._bare is None:
            self._bare = self.doors(_no_leaps(), np.empty(0), False)
        base = self._base_target, self._base_edge, *self._base_rows, *self._edges
        turned = zones.turned_since(self._settled)
        for zone in turned:
            by = int(zones.blocked[zone] - self._counted[zone])
            if by:
                portal, outline = self._base_rows[0], zones.local[zone]
                count_reached(zones.switches, self._bare, portal, zone, outline, by, self._reached)
                self._counted[zone] += by
        near = zones.divided.user_near
        for zone in turned:
            settle_doors(self._net, zones.switches, self._bare, base, zone, near, self._reached, self._kept)
        join_regions(zones.switches, self._bare, zones.divided.fringe, *self.ways)
        self._settled = zones.changes

    def doors(self, leaps: dict[str, np.ndarray], costs: np.ndarray, weighted: bool) -> Any:
        """`DOORS` with these ``leaps``, which start at the nodes of the undivided graph."""
        switches = self._zones.switches
        from_part = self.part[leaps["leap_node"]]
        part_leap_start, part_leap = by_group(from_part, len(self.region))
        parts = {
            "part": self.part, "region": self.region, "ring": self.ring, "part_whole": self._part_whole,
            "anywhere": self._anywhere, "part_leap_start": part_leap_start, "part_leap": part_leap,
        }  # fmt: skip
        parts |= tile_fields(self._tiles, len(self.region))
        leaps = {name: each for name, each in leaps.items() if name != "leap_node"} | {"whole": self.whole}
        portals = self._start, self._doors, self._lens, self._block, switches.head, switches.following
        widest = float(self._zones.undivided.radii.max())
        doors: Any = make_doors(self.radius, portals, costs, weighted, leaps, parts, widest)
        doors.settled = -1  # changes when its closed leaps were last looked at
        return doors


def _with_rows(array: np.ndarray, count: int) -> np.ndarray:
    more = np.empty((count, *array.shape[1:]), array.dtype)
    kept = min(len(array), count)
    more[:kept] = array[:kept]
    return more


def _no_leaps() -> dict[str, np.ndarray]:
    none, points = np.empty(0, np.int32), np.empty((0, 3))
    return {
        "leap_start": none, "leap_id": none, "leap_from": points, "leap_from_cell": none, "leap_to": points,
        "leap_to_cell": none, "leap_cost": np.empty(0), "leap_closed": none, "leap_node": none,
    }  # fmt: skip


def zoned_body(graph: "NodeGraph", radius: float) -> ZonedBody:
    """What a body of ``radius`` [m] makes of a graph with zones, as it is now; made once. To be called with
    `Zones.lock` held."""
    zones = zones_of(graph)
    body = recent(graph.cache, "bodies", radius, lambda: ZonedBody(graph, zones, radius))
    body.settle()
    return body
