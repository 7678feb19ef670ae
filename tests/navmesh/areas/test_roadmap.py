"""The roadmap of a body and its costs: what its landmarks promise."""

import numpy as np
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import dijkstra

from benchmarks.area_costs import COSTS, RADIUS
from navmesh.areas.areas import checked_costs
from navmesh.areas.kernel_arrays import LANDMARKS
from navmesh.areas.pricing import priced_of
from navmesh.graph.open_to_body import doors_of


def test_what_landmarks_say_is_left_is_never_too_much(scene) -> None:
    """Against Dijkstra's algorithm over all roads."""
    _, graph, _, _ = scene
    doors = doors_of(graph, RADIUS, None, None)
    road = priced_of(graph, doors, checked_costs(graph, COSTS)).road
    count = len(road.stops)
    source = np.repeat(np.arange(count), np.diff(road.road_start))
    matrix = csr_matrix((road.roads["toll"], (source, road.roads["to"])), (count, count))
    assert abs(matrix - matrix.T).max() < 1e-12
    goal = int(np.argmax(np.diff(road.road_start)))
    exact = dijkstra(matrix, indices=goal)
    bound = road.landmark[goal]
    there = bound[:LANDMARKS] - road.landmark[:, :LANDMARKS]
    back = road.landmark[:, LANDMARKS:] - bound[LANDMARKS:]
    for low in (there, back):
        assert not (low > exact[:, None] + 1e-9).any()
