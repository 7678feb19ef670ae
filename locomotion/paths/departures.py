"""The first metres of a new path for a running person, which can neither turn nor stop at once."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from locomotion.paths.approach_legs import straight_on
from locomotion.paths.gait_plan import SLOWS_WITHIN, braking_length
from locomotion.paths.table import TrackingLimits
from navmesh.graph.node_graph import NodeGraph
from navmesh.routes.route_validity import line_holds
from navmesh.routes.surface_projection import project_curve_to_surface

__all__ = ["can_begin", "leads"]

_SPACING = 0.25  # [m] between the points of a lead
_ASIDE = 0.3  # [rad] off its direction in which a path may begin
_MOST = 2.0  # [m/s^2] sideways with which it still follows a bend at the beginning
_RESERVE = 0.3  # [m] in addition to braking
_SHARPEST = 0.1  # [1/m] of a bend that begins at once
_FARTHEST = math.radians(120.0)  # turn made while running; for a larger one it is quicker to stop


def can_begin(points: NDArray[np.float64], velocity: NDArray[np.float64], limits: TrackingLimits) -> bool:
    """Whether a runner at ``velocity`` (2,) [m/s] can follow the path ``points`` (n, 3) [m] from its
    beginning, or stop on it before it bends too sharply or ends."""
    speed = float(np.linalg.norm(velocity))
    steps = np.diff(points[:, :2], axis=0)
    lengths = np.linalg.norm(steps, axis=1)
    steps, lengths = steps[lengths > 1e-3], lengths[lengths > 1e-3]
    if len(steps) < 2:
        return False
    at = np.cumsum(lengths)
    room = braking_length(speed) + SLOWS_WITHIN
    headings = np.unwrap(np.arctan2(steps[:, 1], steps[:, 0]))
    off = headings[0] - math.atan2(velocity[1], velocity[0])
    if at[-1] < room or abs(math.remainder(off, 2.0 * math.pi)) > _ASIDE:
        return False
    bends = np.abs(np.diff(headings)) / np.maximum(0.5 * (lengths[1:] + lengths[:-1]), 0.5 * _SPACING)
    slower = np.maximum(speed**2 - 2.0 * limits.deceleration * at[:-1], limits.speeds[0] ** 2)
    too_sharp = (bends > limits.sharpest) | (bends * slower > _MOST)
    return not bool((too_sharp & (at[:-1] < room)).any())


def leads(
    graph: NodeGraph,
    place: NDArray[np.float64],
    velocity: NDArray[np.float64],
    target: NDArray[np.float64],
    limits: TrackingLimits,
    radius: float,
) -> Iterator[tuple[NDArray[np.float64], bool]]:
    """Leads (n, 3) [m], best first, on which a runner at ``place`` (3,) with ``velocity`` (2,) [m/s] can
    begin to go to ``target`` (3,), as far as there is room for a body of ``radius`` [m]; each with whether
    it keeps running: in a bend until it runs towards the target, or straight on until it stops.
    """
    speed = float(np.linalg.norm(velocity))
    forward = velocity / speed
    bend = _bend(place, forward, target, max(speed**2 / limits.sideways, 1.0 / _SHARPEST))
    if bend is not None:
        draped = project_curve_to_surface(graph, bend)
        if line_holds(graph, draped, radius):
            yield draped, True
    end = straight_on(graph, place, forward, braking_length(speed) + SLOWS_WITHIN + _RESERVE, radius)
    if end is not place:
        count = max(math.ceil(float(np.linalg.norm((end - place)[:2])) / _SPACING), 1) + 1
        yield project_curve_to_surface(graph, np.linspace(place, end, count)), False


def _bend(
    place: NDArray[np.float64], forward: NDArray[np.float64], target: NDArray[np.float64], radius: float
) -> NDArray[np.float64] | None:
    """(n, 3) points of the circle of ``radius`` [m] that begins in the direction ``forward`` (2,), until it
    points at ``target``; None if it never does, or turns too far."""
    way = (target - place)[:2]
    ahead, beside = float(forward @ way), float(forward[0] * way[1] - forward[1] * way[0])
    side = math.copysign(1.0, beside)
    # seen from the centre of the circle, which is `radius` to that side
    away = math.hypot(ahead, abs(beside) - radius)
    if away <= radius:
        return None
    angle = math.atan2(ahead, radius - abs(beside)) - math.acos(radius / away)
    angle %= 2.0 * math.pi
    if angle > _FARTHEST:
        return None
    turned = np.linspace(0.0, angle, max(math.ceil(radius * angle / _SPACING), 1) + 1)
    along, across = radius * np.sin(turned), side * radius * (1.0 - np.cos(turned))
    points = np.repeat(place[None], len(turned), axis=0)
    points[:, 0] += along * forward[0] - across * forward[1]
    points[:, 1] += along * forward[1] + across * forward[0]
    return points
