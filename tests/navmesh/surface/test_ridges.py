"""Doors hardly wider than the body, narrower ones, and cracks between tiles: the mesh decides, not the
grid."""

import numpy as np

from navmesh import NodeGraph, Terrain, WalkRules


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
