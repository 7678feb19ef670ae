"""What the first queries on a graph would work out, worked out before they are asked.

After a change of the level that is portals and parts near the change, doors, and memory for a search: tens
of milliseconds in a large level. A game has it done in a thread while it still plays on the graph before.
"""

from typing import TYPE_CHECKING

from navmesh.graph.open_to_body import doors_of, parts_of
from navmesh.routes.path_queries import keep_scratch

if TYPE_CHECKING:
    from navmesh.graph.node_graph import NodeGraph

__all__ = ["prepare_like"]


def prepare_like(graph: "NodeGraph", other: "NodeGraph") -> None:
    """Work out on ``graph`` what queries on the ``other`` have worked out and kept for bodies and skills.
    Costs of links count by number, which may be others here: doors that are priced are left out."""
    offers = [key[:3] for key in tuple(other.cache.get("doors", ()))]
    for radius in tuple(other.cache.get("parts", ())):
        if graph.zone_state is None:
            parts_of(graph, radius)
    for radius, skills, priced in dict.fromkeys(offers):
        if priced is None:
            doors_of(graph, radius, {name: (low, high) for name, low, high in skills}, None)
    if offers:
        keep_scratch(graph)
