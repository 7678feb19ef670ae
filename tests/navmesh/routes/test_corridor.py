"""The corridor of a route: discs that its path runs through, one after another."""

import math

import numpy as np
import pytest

from navmesh.routes.corridor import corridor_of
from tests.navmesh.routes.path_references import scene


@pytest.mark.parametrize("seed", range(6))
def test_the_path_runs_through_its_corridor(seed: int) -> None:
    graph, rng = scene(seed, 9)
    ends = np.column_stack([rng.uniform(0.5, 13.5, (20, 2)), np.zeros(20)])
    for route in graph.find_paths(ends[:10], ends[10:], radius=0.3):
        for leg in route.legs():
            points = np.concatenate(
                [
                    a + (b - a) * np.linspace(0, 1, 2 + int(math.dist(a, b) / 1e-3))[:, None]
                    for a, b in zip(leg.waypoints, leg.waypoints[1:], strict=False)
                ]
            )
            reached = np.zeros(len(points), dtype=bool)
            reached[0] = True
            index = np.arange(len(points))
            for center, radius in zip(leg.centers, leg.radii, strict=True):
                inside = np.hypot(*(points - center)[:, :2].T) <= radius + 1e-3
                last_reached = np.maximum.accumulate(np.where(reached & inside, index, -1))
                last_outside = np.maximum.accumulate(np.where(inside, -1, index))
                reached = inside & (last_reached > last_outside)
            assert reached[-1]


def test_discs_are_clear_of_walls_and_overlap():
    graph, rng = scene(2, 9)
    ends = np.column_stack([rng.uniform(0.5, 13.5, (12, 2)), np.zeros(12)])
    seen = 0
    for route in graph.find_paths(ends[:6], ends[6:], radius=0.3):
        if len(route.waypoints):
            found = corridor_of(graph, route.waypoints, 0.3)
            gaps = [graph.clearance_at(center) for center in found.centers]
            assert (found.radii <= np.array(gaps) - 0.3 + 0.01).all() and (found.radii >= 0.0).all()
            apart = np.linalg.norm(np.diff(found.centers[:, :2], axis=0), axis=1)
            assert (apart <= found.radii[:-1] + found.radii[1:] + 1e-9).all()
            seen += 1
    assert seen >= 4
