"""The way from disc to disc: doors hardly wider than the body are open, narrower ones are not."""

import numpy as np
import pytest

from benchmarks.narrow_doors import door
from navmesh import NodeGraph, WalkRules


def door_passed(rng, width: float, thick: float, radius: float) -> tuple[str, bool]:
    """Two rooms with one door somewhere between them, turned: (status of the route, whether reachable)."""
    terrain, turn, y = door(rng, width, thick)
    graph = NodeGraph.build(terrain, WalkRules(), None)
    start, goal = turn @ (1, 2.5, 0), turn @ (9, 2.5, 0)
    route = graph.find_path(start, goal, radius)
    there = graph.containing_node(goal)
    if route.status == "complete":
        walked = (
            np.concatenate(
                [np.linspace(a, b, 200) for a, b in zip(route.waypoints, route.waypoints[1:], strict=False)]
            )[:, :2]
            @ turn[:2, :2]
        )
        off = [np.maximum(np.abs(walked[:, 0] - 5) - thick / 2, 0)]
        low = np.hypot(off[0], np.maximum(walked[:, 1] - (y - width / 2), 0))
        high = np.hypot(off[0], np.maximum((y + width / 2) - walked[:, 1], 0))
        assert min(low.min(), high.min()) > radius - 1e-3
    return route.status, bool(np.isin(there, graph.reachable_nodes(start, radius)))


@pytest.mark.parametrize("thick", [0.02, 0.2, 1.5])
@pytest.mark.parametrize("radius", [0.2, 0.3, 0.6])
def test_a_door_two_centimetres_wider_than_the_body_passes(radius: float, thick: float) -> None:
    rng = np.random.default_rng([2, int(1000 * radius), int(1000 * thick)])
    for _ in range(6):
        width = 2 * radius + rng.choice([0.02, 0.05, 0.1])
        assert door_passed(rng, width, thick, radius) == ("complete", True)


@pytest.mark.parametrize("thick", [0.02, 0.2, 1.5])
@pytest.mark.parametrize("radius", [0.2, 0.3, 0.6])
def test_a_door_narrower_than_the_body_does_not(radius: float, thick: float) -> None:
    rng = np.random.default_rng([3, int(1000 * radius), int(1000 * thick)])
    for _ in range(6):
        width = 2 * radius - rng.choice([0.01, 0.05, 0.2])
        assert door_passed(rng, width, thick, radius) == ("partial", False)
