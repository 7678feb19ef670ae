"""Straight ways over successive obstacles.

Of the parallel links over each obstacle, a route takes those that make it shortest. Where two obstacles are
close together, a sidestep between them leaves no straight run-up to the second: a person then aborts its
run-up, goes back and finds no better one. Here such a route is moved to links in one line, if there are any.
"""

from __future__ import annotations

from collections.abc import Mapping
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from navmesh.graph.node_graph import NodeGraph
from navmesh.routes.route import LinkUse, Route

__all__ = ["lined_up"]

_CLOSE = 14.0  # [m] between two obstacles: landing, a bend and a run-up
_BEGINS = 6.0  # [m] from the start to the first link within which a bend shortens the run-up
_ALIKE = 0.7  # cosine of the largest angle between successive links in line
_ASIDE = 0.05  # [m] beside the line of a link that does not matter
_SIDEWAYS = 6.0  # [m] of way that avoiding one metre sideways between two such links is worth
_LONGER = 4.0  # [m] by which the way may become longer
_SPREAD = 6.0  # [m] from the route's link to alternatives


def lined_up(
    route: Route, skills: Mapping[str, tuple[float, float]], link_costs: NDArray[np.float64] | None = None
) -> Route:
    """``route``, found with ``skills`` and ``link_costs``, moved to links of the same obstacles that are as
    nearly in line as possible; unchanged if they already are."""
    if not route.links:
        return route
    begins = _from_start(route.graph, route.waypoints[0], route.links[0].link) > _SIDEWAYS * _ASIDE
    if not begins and not any(_needs_it(route, a, b) for a, b in pairwise(route.links)):
        return route
    choices = [_beside(route, use, skills, link_costs) for use in route.links]
    links = _straightest(route.graph, route.waypoints[0], route.waypoints[-1], choices)
    if links == [use.link for use in route.links]:
        return route
    return _over(route, links) or route


def _needs_it(route: Route, one: LinkUse, other: LinkUse) -> bool:
    forward, aside = _offset(route.graph, one.link, other.link)
    return aside > _ASIDE and 0.0 < forward < _CLOSE


def _offset(graph: NodeGraph, one: int, other: int) -> tuple[float, float]:
    """[m] from the end of a link to the start of the next, along and across it; (0, 0) if the two have
    different directions."""
    links = graph.links
    first, second = _unit(links.end[one] - links.start[one]), _unit(links.end[other] - links.start[other])
    if float(first @ second) < _ALIKE:
        return 0.0, 0.0
    way = (links.start[other] - links.end[one])[:2]
    return float(way @ second), abs(float(second[0] * way[1] - second[1] * way[0]))


def _beside(
    route: Route,
    use: LinkUse,
    skills: Mapping[str, tuple[float, float]],
    link_costs: NDArray[np.float64] | None,
) -> list[int]:
    """Links over the obstacle of ``use`` that the body can take, near that one."""
    links = route.graph.links
    low, high = skills.get(str(links.affordance[use.link]), (np.inf, -np.inf))
    fits = (links.obstacle == use.obstacle) & (links.radius >= route.radius)
    fits &= (links.height >= low) & (links.height <= high)
    fits &= np.linalg.norm(links.edge - links.edge[use.link], axis=1) <= _SPREAD
    if link_costs is not None:
        fits &= np.isfinite(link_costs)
    fits[use.link] = True
    return np.flatnonzero(fits).tolist()


def _straightest(
    graph: NodeGraph, start: NDArray[np.float64], goal: NDArray[np.float64], choices: list[list[int]]
) -> list[int]:
    """One link of each of ``choices``: the shortest way over them, with costs for sidesteps."""
    links = graph.links
    costs = [_away(start, links.start[each]) + _from_start(graph, start, each) for each in choices[0]]
    cames: list[list[int]] = []
    for before, after in pairwise(choices):
        table = [[cost + _between(graph, a, b) for a, cost in zip(before, costs, strict=True)] for b in after]
        cames.append([int(np.argmin(row)) for row in table])
        costs = [min(row) for row in table]
    last = int(
        np.argmin([cost + _away(links.end[e], goal) for e, cost in zip(choices[-1], costs, strict=True)])
    )
    chosen = [last]
    for came in reversed(cames):
        chosen.append(came[chosen[-1]])
    return [options[k] for options, k in zip(choices, reversed(chosen), strict=True)]


def _from_start(graph: NodeGraph, start: NDArray[np.float64], link: int) -> float:
    """[m] cost of a sidestep right before the first link."""
    along = _unit(graph.links.end[link] - graph.links.start[link])
    way = (graph.links.start[link] - start)[:2]
    aside = abs(float(along[0] * way[1] - along[1] * way[0]))
    return _SIDEWAYS * aside if 0.0 < float(along @ way) < _BEGINS else 0.0


def _between(graph: NodeGraph, one: int, other: int) -> float:
    """[m] cost of the way from a link to the next."""
    forward, aside = _offset(graph, one, other)
    extra = _SIDEWAYS * aside if 0.0 < forward < _CLOSE else 0.0
    return _away(graph.links.end[one], graph.links.start[other]) + extra


def _over(route: Route, chosen: list[int]) -> Route | None:
    """The route over ``chosen`` links; None if none is only slightly longer."""
    graph, links = route.graph, route.graph.links
    starts = [route.waypoints[0], *links.end[chosen]]
    ends = [*links.start[chosen], route.waypoints[-1]]
    nodes, points, uses = [], [], []
    count = 0
    for number, (start, end) in enumerate(zip(starts, ends, strict=True)):
        leg = graph.find_path(start, end, radius=route.radius)
        if leg.status != "complete":
            return None
        nodes.append(leg.nodes)
        points.append(leg.waypoints)
        count += len(leg.waypoints)
        if number < len(chosen):
            link = chosen[number]
            uses.append(LinkUse(link, int(links.obstacle[link]), count - 1, count))
    waypoints = np.concatenate(points)
    length = float(np.linalg.norm(np.diff(waypoints, axis=0), axis=1).sum())
    if length > route.length + _LONGER:
        return None
    status, radius, expanded = route.status, route.radius, route.expanded
    return Route(status, radius, np.concatenate(nodes), waypoints, length, uses, expanded, graph)


def _away(one: NDArray[np.float64], other: NDArray[np.float64]) -> float:
    return float(np.linalg.norm(other - one))


def _unit(direction: NDArray[np.float64]) -> NDArray[np.float64]:
    """(2,) of length 1."""
    return direction[:2] / np.linalg.norm(direction[:2])
