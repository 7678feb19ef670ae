"""What queries worked out on a graph before an update, for the graph after it to take over: portals and parts
by radius, and where crowds find passages narrow, by width. It is renewed when a query asks for it, not by the
update (`navmesh.graph.portal_changes`, `navmesh.graph.part_changes`, `locomotion.crowd.throats`)."""

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from navmesh.recent import KEPT
from navmesh.surface.build import Window

if TYPE_CHECKING:
    from navmesh.graph.node_graph import NodeGraph

__all__ = ["Changes", "Earlier", "carry_over", "earlier_of"]

_KINDS = "portals", "parts", "throats"
_MOST = 16
"""Changed windows after which what nobody asked for is not kept any longer."""


@dataclass(frozen=True, slots=True, eq=False)
class Changes:
    """What is other than before on a surface and its nodes."""

    number: np.ndarray
    """(m before,) int32: what number each node of before has now, rising, or -1 for those that are gone."""
    windows: tuple[Window, ...]
    """Outside of them all cells, clearances and labels are as before, but for the numbers."""

    def and_then(self, later: "Changes") -> "Changes":
        """These changes and ``later`` ones."""
        number = np.append(later.number, np.int32(-1))[self.number]  # -1 stays -1
        return Changes(number, self.windows + later.windows)


@dataclass(frozen=True, slots=True, eq=False)
class Earlier:
    """What was known of a graph, for one radius or width, before some changes."""

    known: tuple[Any, ...]
    """Arrays, or tuples of them."""
    column_start: np.ndarray
    milestone: np.ndarray
    """Those of the surface then."""
    changes: Changes


def carry_over(before: "NodeGraph", after: "NodeGraph", changes: Changes) -> None:
    """Let the graph ``after`` some changes take over what is known of the graph ``before`` them, and what
    ``before`` itself has not taken over yet, because nobody asked for it."""
    surface = before.surface
    for kind in _KINDS:
        known, waiting = before.cache.get(kind, {}), before.cache.get(_waiting(kind), {})
        found = {}
        for radius in tuple(waiting):  # another thread may ask for one meanwhile
            earlier = waiting.get(radius)
            if earlier is not None and len(earlier.changes.windows) + len(changes.windows) <= _MOST:
                found[radius] = replace(earlier, changes=earlier.changes.and_then(changes))
        for radius in tuple(known):
            values = known.get(radius)
            if values is not None:
                found[radius] = Earlier(values, surface.column_start, surface.milestone, changes)
        after.cache[_waiting(kind)] = dict(list(found.items())[-KEPT:])


def earlier_of(graph: "NodeGraph", kind: str, radius: float) -> Earlier | None:
    """What the graph can take over of a ``kind``, one of `_KINDS`, for a body of ``radius`` [m]: once."""
    return graph.cache.get(_waiting(kind), {}).pop(radius, None)


def _waiting(kind: str) -> str:
    return f"earlier {kind}"
