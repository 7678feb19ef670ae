"""People find their way through a whole level: ramps, corners, storeys, walking and running."""

from pathlib import Path

import numpy as np
import pytest

import navmesh
from locomotion import Ground, smooth_route
from runtime.events import Fell
from runtime.planning.rules import person_walk_rules
from runtime.world.world import World

LEVEL = Path(__file__).parents[3] / "examples" / "levels" / "courtyard.obj"


@pytest.fixture(scope="module")
def graph():
    return navmesh.NodeGraph.build(navmesh.Terrain.load(LEVEL, up="z"), person_walk_rules())


@pytest.mark.parametrize("speed", [1.2, 3.2])
def test_most_random_ways_are_gone_to_their_end(graph, speed):
    rng = np.random.default_rng(4)
    places = graph.positions[np.flatnonzero(graph.radii > 0.5)]
    arrived, tried, unharmed = 0, 0, 0
    while tried < 5:
        start, goal = places[rng.choice(len(places), 2)]
        route = graph.find_path(start, goal, radius=0.3)
        if route.status != "complete" or not 10.0 < route.length < 40.0 or len(route.links):
            continue
        tried += 1
        world = World(graph, seed=tried)
        person = world.spawn("human", start, facing=float(rng.uniform(-3, 3)))
        person.go_to(goal, speed=speed)
        while person.moving and world.time < 80.0:
            world.step(0.1)
        arrived += person.status == "arrived"
        unharmed += not any(isinstance(event, Fell) for event in world.events)
        assert person.status not in ("lost", "stuck")
    assert arrived == 5
    assert unharmed >= 4


def test_smoothed_ways_lie_on_the_ground_between_their_corners(graph):
    """Over the ramp, whose top and bottom are far from the corners of the pulled line."""
    ground = Ground.from_arrays(graph.terrain.vertices, graph.terrain.faces)
    route = graph.find_path((30.0, 38.0, 3.0), (56.0, 34.0, 0.0), radius=0.3)
    assert route.status == "complete"
    points = smooth_route(route).points
    heights = ground.surface_below(points + np.array([0.0, 0.0, 0.3]))[0]
    assert np.ptp(heights) > 2.5
    assert np.abs(points[:, 2] - heights).max() < 0.05
