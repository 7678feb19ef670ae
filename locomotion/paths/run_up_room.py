"""Links without room for a person's run-up."""

import numpy as np
from numpy.typing import NDArray

from navmesh.graph.node_graph import NodeGraph
from navmesh.graph.spatial_queries import cast_ray
from navmesh.recent import recent

__all__ = ["LEAST_RUN_UP", "cramped_links", "straight_before"]

LEAST_RUN_UP = 4.0
"""[m] of free straight run-up before an edge; with less, nobody has managed to take off, whatever the skill
and size."""


def cramped_links(graph: NodeGraph, radius: float) -> NDArray[np.int64]:
    """(k,) indices of the links of ``graph`` with less than `LEAST_RUN_UP` of straight run-up for a body of
    ``radius`` [m], with the zones that are blocked now; those looked at last are kept."""

    def make() -> NDArray[np.int64]:
        return np.flatnonzero(straight_before(graph, radius, LEAST_RUN_UP) < LEAST_RUN_UP - 1e-6)

    blocked = b"" if graph.zone_state is None else graph.zone_state.blocked.tobytes()
    return recent(graph.cache, "cramped_links", (radius, blocked), make)


def straight_before(graph: NodeGraph, radius: float, most: float) -> NDArray[np.float64]:
    """(l,) [m] that a body of ``radius`` [m] can walk straight up to the edge of each link, up to ``most``
    [m]."""
    links = graph.links
    if not len(links):
        return np.empty(0)
    along = links.start[:, :2] - links.edge[:, :2]
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    behind = np.maximum(most - links.run_up, 0.0)
    ends = links.start + np.column_stack([along * np.maximum(behind, 1e-3)[:, None], np.zeros(len(links))])
    return links.run_up + behind * np.asarray(cast_ray(graph, links.start, ends, radius).share)
