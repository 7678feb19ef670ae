"""Links that blocked zones are in the way of."""

from typing import TYPE_CHECKING, Any

import numpy as np

from navmesh.zones.distances import segments_to_outline

if TYPE_CHECKING:
    from navmesh.graph.node_graph import NodeGraph
    from navmesh.zones.zones import Zones

__all__ = ["link_room", "links_near", "settle_leaps"]


def links_near(graph: "NodeGraph", outlines: list[np.ndarray]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Which links of a graph lead so near to which ``outlines`` (k, 3) [m] that a body may not pass if these
    are blocked: zone, link (k,) int and the distance (k,) [m], horizontally.

    What is blocked reaches from half of `WalkRules.headroom` below its outline to headroom above it.
    """
    links, headroom = graph.links, graph.rules.headroom
    segments = np.column_stack([links.start[:, :2], links.end[:, :2]])
    heights = np.column_stack([links.start[:, 2], links.edge[:, 2], links.end[:, 2]])
    least, most = heights.min(axis=1), heights.max(axis=1)
    zones, found, away = [], [], []
    for zone, outline in enumerate(outlines):
        low, high = outline[:, 2].min() - 0.5 * headroom, outline[:, 2].max() + headroom
        near = (least <= high) & (most >= low)
        for axis in range(2):
            ends = segments[:, axis::2]
            near &= ends.min(axis=1) <= outline[:, axis].max() + links.radius
            near &= ends.max(axis=1) >= outline[:, axis].min() - links.radius
        those = np.flatnonzero(near)
        far = segments_to_outline(np.ascontiguousarray(outline[:, :2]), segments[those])
        close = far < links.radius[those]
        found.append(those[close])
        away.append(far[close])
        zones.append(np.full(close.sum(), zone))
    return np.concatenate(zones), np.concatenate(found), np.concatenate(away)


def link_room(graph: "NodeGraph") -> np.ndarray:
    """(l,) float64 [m]: the radius of the widest body that each link lets pass with what is blocked now; -1
    for links that cross what is."""
    if graph.zone_state is None:
        return graph.links.radius
    return _room(graph.zone_state)


def _room(zones: "Zones") -> np.ndarray:
    room = zones.undivided.links.radius.copy()
    zone, link, away = zones.divided.links
    there = zones.blocked[zone] == 1
    np.minimum.at(room, link[there], np.where(away[there] > 0.0, away[there], -1.0))
    return room


def settle_leaps(zones: "Zones", doors: Any) -> None:
    """Bring ``doors.leap_closed`` to what it is with the zones that are blocked now."""
    if len(zones.divided.links[0]) and len(doors.leap_id) and doors.settled != zones.changes:
        doors.leap_closed[:] = _room(zones)[doors.leap_id] < doors.radius
    doors.settled = zones.changes
