"""The zones of a graph: which there are, which are blocked, and what follows for a body of some radius."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from navmesh.errors import NavmeshError
from navmesh.graph.kernel_arrays import net_of
from navmesh.graph.parts import regions_of_parts, ways_by_part
from navmesh.zones.lists import grouped
from navmesh.zones.switching import SWITCHES, turn_all
from surefoot.kernels import kernel
from surefoot.kernels.bundles import Bundle

if TYPE_CHECKING:
    from navmesh.graph.node_graph import NodeGraph

__all__ = ["Passages", "Zones"]


@dataclass(eq=False)
class Zones:
    """The zones of a divided graph. Its arrays say what there is with the zones that are blocked now."""

    outlines: dict[str, np.ndarray]
    """(k, 3) float64 [m] each, by name."""
    undivided: "NodeGraph"
    node_view: np.ndarray
    """(m,) int32: the view of each node, -1 for those that always are there; see `navmesh.zones.dividing`."""
    edge_view: np.ndarray
    """(e,) int32, alike."""
    zones_of_view: np.ndarray
    """(v, 2) int32: one zone, twice, or two."""
    switches: dict[str, np.ndarray]
    """The arrays of `SWITCHES`."""
    changes: int = 0
    """How often zones have been blocked or opened."""
    _bundle: Any = field(default=None, repr=False)
    _number: dict[str, int] = field(init=False, repr=False)

    def __post_init__(self) -> None:
        self._number = {name: number for number, name in enumerate(self.outlines)}

    def turn(self, graph: "NodeGraph", names: Sequence[str], blocked: bool) -> None:
        """Block the zones of these names, or open them."""
        for name in names:
            if name not in self._number:
                raise NavmeshError(f"there is no zone {name!r}; there are {', '.join(self._number)}")
        self._turn(graph, np.array([self._number[name] for name in names], np.int32), blocked)

    def turn_to(self, graph: "NodeGraph", blocked: np.ndarray) -> None:
        """Block and open zones as ``blocked`` (z,) says."""
        self._turn(graph, np.arange(len(blocked), dtype=np.int32), blocked)

    def _turn(self, graph: "NodeGraph", zones: np.ndarray, blocked: Any) -> None:
        if self._bundle is None:
            self._bundle = Bundle(SWITCHES, **self.switches)
        to = np.broadcast_to(np.asarray(blocked, np.int32), zones.shape).copy()
        turn_all(self._bundle, net_of(graph), zones, to)
        self.changes += 1

    @property
    def blocked(self) -> np.ndarray:
        """(z,) int32: 1 for each zone that is blocked, 0 for the others."""
        return self.switches["blocked"]

    @property
    def missing(self) -> np.ndarray:
        """(v,) int32: how many zones of each view are blocked."""
        return self.switches["view_missing"]

    def as_divided(self, graph: "NodeGraph") -> Iterator[int]:
        """Bring the graph into the states in which its parts were found: -1, all zones blocked, then each
        view with only its zones open; at last that of now."""
        now = self.blocked.copy()
        try:
            self.turn_to(graph, np.ones_like(now))
            yield -1
            for view, zones in enumerate(self.zones_of_view):
                self._turn(graph, zones, False)
                yield view
                self._turn(graph, zones, True)
        finally:
            self.turn_to(graph, now)

    def lasting_label(self, graph: "NodeGraph", cells: np.ndarray) -> np.ndarray:
        """(k,) int32: for each of ``cells`` (k,) a node that it has whenever it has one: that with all zones
        blocked or, inside a zone, one with only that open; -1 without any."""
        label = graph.label[cells]
        row = np.searchsorted(self.switches["row_cell"], cells)
        near = row < len(self.switches["row_cell"])
        near[near] = self.switches["row_cell"][row[near]] == cells[near]
        row = row[near]
        own_start, own_label = self.switches["own_start"], self.switches["own_label"]
        of_row = self.switches["row_label"][row]
        inside = (of_row < 0) & (own_start[row + 1] > own_start[row])
        of_row[inside] = own_label[own_start[row[inside]]]
        label[near] = of_row
        return label


class Passages:
    """The doors of one body radius that come and go with zones, and what they join."""

    def __init__(self, zones: Zones, start: np.ndarray, view: np.ndarray, target: np.ndarray) -> None:
        """``start`` (m + 1,) and ``target`` (p,), which is kept up to date, are the doors, as in `DOORS`, and
        ``view`` (p,) is the view that has each, or -1."""
        rows = np.flatnonzero(view >= 0).astype(np.int32)
        self.view = view[rows]
        """(r,) int32, of these doors."""
        self.source = np.searchsorted(start, rows, side="right") - 1
        self.target = target[rows]
        self.zones = zones
        self._live = target
        count = len(zones.zones_of_view)
        self._start, self._row, self._to = grouped(self.view, count, rows, self.target)
        self._there = np.ones(count, np.int32)
        self._changes = -1

    def join(self, part: np.ndarray) -> None:
        """Take note of the parts of all nodes (m,)."""
        self._ways = ways_by_part(part, self.source, self.target, self.view)
        start, to, _ = self._ways
        source = np.repeat(np.arange(len(start) - 1, dtype=np.int32), np.diff(start))
        self._touched = np.unique(np.concatenate([source, to])).astype(np.int32)
        self.region = np.arange(len(start) - 1, dtype=np.int32)
        """(p,) int32: see `DOORS`."""

    def settle(self) -> None:
        """Bring doors and regions to what they are with the zones that are blocked now."""
        if self._changes == self.zones.changes:
            return
        _settle_doors(self.zones.missing, self._there, self._start, self._row, self._to, self._live)
        regions_of_parts(self._touched, *self._ways, self.zones.missing, self.region)
        self._changes = self.zones.changes


@kernel
def _settle_doors(missing, there, start, row, to, target):
    """Put right the targets of the doors of all views for which ``there`` (v,), 1 or 0, is out of date."""
    for view in range(missing.size):
        now = 1 if missing[view] == 0 else 0
        if there[view] != now:
            there[view] = now
            for i in range(start[view], start[view + 1]):
                target[row[i]] = to[i] if now == 1 else -1
