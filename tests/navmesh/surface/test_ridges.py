"""Doors hardly wider than the body, narrower ones, and cracks between tiles: the mesh decides, not the
grid."""

import numpy as np
import pytest

from benchmarks.narrow_doors import door
from navmesh import NodeGraph, Terrain, WalkRules
from tests.navmesh.shapes import join, plane


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


def tiles(side: float, count: int, half: float):
    at = [(side * i - half, side * i + half) for i in range(count)]
    return join(*(plane(*x, *y) for x in at for y in at))


@pytest.mark.parametrize("seam", [5.0, 5.1, 5.125, 5.15])
@pytest.mark.parametrize("crack", [4e-9, 1e-6, 0.01, 0.05, 0.09])
def test_a_crack_is_floor(seam: float, crack: float) -> None:
    level = join(plane(0, seam - crack / 2, 0, 4), plane(seam + crack / 2, 10, 0, 4))
    graph = NodeGraph.build(Terrain.from_arrays(*level), WalkRules(), None)
    assert graph.find_path((1, 2, 0), (9, 2, 0), 0.3).status == "complete"
    assert graph.clearance_at((seam, 2.1, 0)) > 1.7  # nothing ends walking there


def test_a_gap_as_wide_as_a_cell_is_not() -> None:
    for seam in np.linspace(5, 5.25, 6):
        level = join(plane(0, seam - 0.18, 0, 4), plane(seam + 0.18, 10, 0, 4))
        graph = NodeGraph.build(Terrain.from_arrays(*level), WalkRules(), None)
        assert graph.find_path((1, 2, 0), (9, 2, 0), 0.3).status == "partial"


@pytest.mark.parametrize("resolution", [0.25, 0.1])
@pytest.mark.parametrize("side", [1.25, 2.5])
def test_tiles_scaled_in_single_precision_are_one_floor(side: float, resolution: float) -> None:
    half = 50 * side * float(np.float32(0.01))
    graph = NodeGraph.build(
        Terrain.from_arrays(*tiles(side, 4, half)), WalkRules(resolution=resolution), None
    )
    far = 3.8 * side - half
    assert graph.find_path((0.1, 0.1, 0), (far, far, 0), 0.3).status == "complete"


def test_floor_under_a_sloping_ceiling_ends_where_a_body_no_longer_fits() -> None:
    """A slab whose underside cuts through the floor: beside its wall, the floor within is a sliver that ends
    where the underside comes out of it, and no node lies beyond."""
    floor = np.array([[-4.0, -4.0, 0.0], [4.0, -4.0, 0.0], [4.0, 4.0, 0.0], [-4.0, 4.0, 0.0]])
    for off in np.linspace(0.0, 0.25, 51):
        under = [[-2.0, off, -0.05], [2.0, off, -0.05], [2.0, 3.0 + off, 1.2], [-2.0, 3.0 + off, 1.2]]
        slab = np.vstack([under, under + np.array([0.0, 0.0, 3.0])])
        faces = [
            [0, 1, 2], [0, 2, 3],  # the floor
            [4, 6, 5], [4, 7, 6], [8, 9, 10], [8, 10, 11],  # the slab's underside and top
            *([4 + i, 4 + (i + 1) % 4, 8 + (i + 1) % 4] for i in range(4)),
            *([4 + i, 8 + (i + 1) % 4, 8 + i] for i in range(4)),
        ]  # fmt: skip
        terrain = Terrain.from_arrays(np.vstack([floor, slab]), np.array(faces))
        graph = NodeGraph.build(terrain, WalkRules(max_step=0.9), None)
        within = (np.abs(graph.positions[:, 0]) < 2.0) & (graph.positions[:, 2] < 0.5)
        within &= (graph.positions[:, 1] > off) & (graph.positions[:, 1] < 3.0 + off)
        ahead = 0.05 / 1.25 * 3.0 + off  # where the underside comes out of the floor
        assert np.all(graph.positions[within, 1] < ahead + 0.05)
