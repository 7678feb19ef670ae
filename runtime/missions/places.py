"""Whether the places that a mission names are places on its level, and which would be, where they are not."""

import numpy as np

import navmesh

__all__ = ["what_is_wrong"]

_ASIDE = 0.25  # [m] to which a place may be from where the body fits
_UP = 0.5  # [m] that it may be above or below the floor there


def what_is_wrong(
    level: navmesh.NodeGraph | navmesh.OpenWorld, point: np.ndarray, radius: float, body: str
) -> str | None:
    """Why a body of ``radius`` [m] cannot be at ``point`` (3,) [m] and where it can be near by; None where
    nothing is wrong. Of an open world nothing need be loaded. Raises `NavmeshError` for a body that is too
    wide for it."""
    place = _here(level, point, radius)
    if place is None:
        place = _nearest(level, point, radius)
        if place is None:
            return f"a {body} fits nowhere on the level"
        nearest = f"the nearest place where a {body} fits is {_named(place)}"
        return f"{_named(point)} is not on the floor, or in a wall; {nearest}"
    aside, up = float(np.hypot(*(place - point)[:2])), float(point[2] - place[2])
    if aside > _ASIDE:
        return (
            f"{_named(point)} is in a wall, off the floor, or too near to where it ends; the nearest place "
            f"where a {body} fits is {_named(place)}"
        )
    if abs(up) > _UP:
        side = "above" if up > 0.0 else "below"
        return f"{_named(point)} is {abs(up):.2f} m {side} the floor; the floor there is at {_named(place)}"
    return None


def _here(
    level: navmesh.NodeGraph | navmesh.OpenWorld, point: np.ndarray, radius: float
) -> np.ndarray | None:
    """The place (3,) to which a body of ``radius`` [m] is moved that is put at ``point``."""
    if isinstance(level, navmesh.OpenWorld):
        return level.place_near(point, radius)
    here = level.find_path(point, point, radius=radius)
    return here.waypoints[0] if here.status == "complete" else None


def _nearest(
    level: navmesh.NodeGraph | navmesh.OpenWorld, point: np.ndarray, radius: float
) -> np.ndarray | None:
    """The place (3,) nearest to ``point`` in the discs that hold a body of ``radius`` [m]."""
    if isinstance(level, navmesh.OpenWorld):
        return level.place_near(point, radius, anywhere=True)
    graph = level
    wide = np.flatnonzero(graph.radii >= radius)
    if not len(wide):
        return None
    centres, room = graph.positions[wide], graph.radii[wide] - radius
    way = point - centres
    flat = np.linalg.norm(way[:, :2], axis=1)
    share = np.minimum(room / np.maximum(flat, 1e-9), 1.0)
    places = centres + np.column_stack([share[:, None] * way[:, :2], np.zeros(len(wide))])
    place = places[np.argmin(np.linalg.norm(places - point, axis=1))]
    here = graph.find_path(place, place, radius=radius)  # at the height of the floor there
    return here.waypoints[0] if here.status == "complete" else place


def _named(point: np.ndarray) -> str:
    return str([round(float(value), 2) + 0.0 for value in point])
