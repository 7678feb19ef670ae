"""The zones of a graph: which there are, which are blocked, and what follows for a body of some radius."""

import threading
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from navmesh.errors import NavmeshError
from navmesh.graph.kernel_arrays import net_of
from navmesh.zones.dividing import Divided, divide
from navmesh.zones.memo import nothing_kept
from navmesh.zones.switches import SLOTS, SWITCHES
from navmesh.zones.switching import turn
from surefoot.kernels.bundles import Bundle

if TYPE_CHECKING:
    from navmesh.graph.node_graph import NodeGraph

__all__ = ["Zones", "rebuilt", "zoned_graph", "zones_of"]

_KEPT = 256  # edges for each zone


class Zones:
    """The zones of a graph, and what there is with those that are blocked now."""

    def __init__(
        self, outlines: dict[str, np.ndarray], undivided: "NodeGraph", divided: Divided, arrays: dict
    ) -> None:
        """``arrays``: the fields of `SWITCHES` of the zoned graph that ``divided`` does not have."""
        self.outlines = outlines
        """(k, 3) float64 [m] each, by name."""
        self.undivided = undivided
        self.divided = divided
        self.local = [
            np.ascontiguousarray((outline - undivided.surface.origin)[:, :2]) for outline in outlines.values()
        ]
        """(k, 2) float64 [m] each: relative to the surface's origin."""
        self.changes = 0
        """How often zones have been blocked or opened."""
        self.lock = threading.RLock()
        """Held while doors are made, or brought to what they are now."""
        self._number = {name: number for number, name in enumerate(outlines)}
        self._fields = divided.switches | arrays
        self._log: list[int] = []
        self._first = 0  # changes before the log begins
        self._with_slots(max(4096, int(divided.bound.max(initial=0))))

    def _with_slots(self, count: int) -> None:
        """Have room for ``count`` slots, at least those that there are."""
        old = self._fields
        for name, kind, shape in (
            ("following", np.int32, ()), ("target", np.int32, ()), ("made", np.int64, ()),
            ("width", np.float64, ()),
            ("gate", np.float64, (2,)), ("border", np.int32, (2,)),
        ):  # fmt: skip
            fresh = np.empty((count, *shape), kind)
            if name in old:
                fresh[: len(old[name])] = old[name]
            old[name] = fresh
        self.switches: Any = Bundle(SWITCHES, **old)

    def turn(self, graph: "NodeGraph", names: Sequence[str], blocked: bool) -> None:
        """Block the zones of these names, or open them."""
        for name in names:
            if name not in self._number:
                known = ", ".join(map(repr, self._number))
                raise NavmeshError(f"there is no zone {name!r}; expected one of {known}")
        net = net_of(graph)
        with self.lock:
            for name in names:
                zone = self._number[name]
                if self.blocked[zone] == blocked:
                    continue
                self._turn_one(net, zone, blocked)
                self._log.append(zone)
                self.changes += 1
            if len(self._log) > max(1024, 2 * len(self._number)):
                self._first += len(self._log) - 256
                del self._log[:-256]

    def rehearse(self, graph: "NodeGraph") -> None:
        """Block and open each zone by itself, so that its pieces are known when it is blocked for the first
        time."""
        net = net_of(graph)
        for zone in range(len(self.outlines)):
            for blocked in (True, False):
                self._turn_one(net, zone, blocked)

    def _turn_one(self, net: Any, zone: int, blocked: bool) -> None:
        most = self._fields["numbers"][SLOTS] + self.divided.bound[zone]
        if most > len(self._fields["target"]):
            self._with_slots(2 * int(most))
        turn(self.switches, net, zone, int(blocked))

    def turned_since(self, change: int) -> list[int]:
        """The zones turned since there were so many changes, each once; all if that is not known any more."""
        if change < self._first:
            return [] if self.changes == 0 else list(range(len(self._number)))
        return sorted(set(self._log[change - self._first :]))

    @property
    def blocked(self) -> np.ndarray:
        """(z,) int32: 1 for each zone that is blocked, 0 for the others."""
        return self._fields["blocked"]

    @property
    def names(self) -> dict[str, bool]:
        """Whether each zone is blocked, by its name."""
        return dict(zip(self.outlines, map(bool, self.blocked), strict=True))

    @property
    def slots(self) -> int:
        """How many slots there is room for."""
        return len(self._fields["target"])


def zones_of(graph: "NodeGraph") -> Zones:
    """The zones of a graph that has some."""
    assert graph.zone_state is not None
    return graph.zone_state


def zoned_graph(
    graph: "NodeGraph", outlines: dict[str, np.ndarray], may_be_nowhere: set[str], blocked: dict[str, bool]
) -> "NodeGraph":
    """The ``graph``, which has no zones, with those of ``outlines``, of which some are ``blocked``; see
    `divide`."""
    if not outlines:
        return graph
    zoned = _all_open(graph, outlines, may_be_nowhere)
    zones_of(zoned).rehearse(zoned)
    return _blocked(zoned, blocked)


def rebuilt(graph: "NodeGraph", outlines: dict[str, np.ndarray], blocked: dict[str, bool]) -> "NodeGraph":
    """A zoned graph of its own again, after an update, from what makes it up. A game may be waiting, so
    nothing is rehearsed."""
    return _blocked(_all_open(graph, outlines, set(outlines)), blocked) if outlines else graph


def _all_open(graph: "NodeGraph", outlines: dict[str, np.ndarray], may_be_nowhere: set[str]) -> "NodeGraph":
    divided = divide(graph, outlines, may_be_nowhere)
    pieces = len(divided.switches["row_cell"])
    count = len(graph) + pieces
    positions = np.concatenate([graph.positions, np.zeros((pieces, 3))])
    radii = np.concatenate([graph.radii, np.full(pieces, -1.0)])
    start = np.concatenate([graph.edge_start, np.full(pieces, graph.edge_start[-1], np.int32)])
    label = graph.label.copy()
    kept = nothing_kept(_KEPT * len(outlines))
    arrays = {
        "numbers": np.array([0, -1, 0], np.int64), "head": np.full(count, -1, np.int32),
        "node_sign": np.zeros(len(graph), np.int64), "kept": kept,
        "kept_place": np.empty((len(kept), 3)), "kept_border": np.empty((len(kept), 2), np.int32),
        "all_label": label, "all_radius": radii, "all_position": positions,
    }  # fmt: skip
    zones = Zones(outlines, graph, divided, arrays)
    return replace(
        graph, surface=divided.surface, positions=positions, radii=radii, label=label, edge_start=start,
        node_cell=np.concatenate([graph.node_cell, np.zeros(pieces, np.int32)]), zone_state=zones, cache={},
    )  # fmt: skip


def _blocked(zoned: "NodeGraph", blocked: dict[str, bool]) -> "NodeGraph":
    zones_of(zoned).turn(zoned, [name for name, is_so in blocked.items() if is_so], True)
    return zoned
