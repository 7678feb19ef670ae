"""A room with a passage that leads nowhere, and a planner on a graph."""

import navmesh
from locomotion import smooth_route
from locomotion.quadruped import load_body
from tests.locomotion.quadruped.scenes import floor, quads, wall

DOG = load_body("dog")


class GraphPlanner:
    """A planner on a graph."""

    def __init__(self, vertices, faces):
        terrain = navmesh.Terrain.from_arrays(vertices, faces)
        self.graph = navmesh.NodeGraph.build(terrain, DOG.walk_rules(0.08), obstacle_rules=None)

    def way(self, start, goal, direction):
        route = self.graph.find_path(start, goal, radius=DOG.radius)
        if route.status != "complete":
            raise ValueError(route.status)
        return smooth_route(route, DOG.smoothing, direction)

    def leads(self, start, goal):
        return self.graph.find_path(start, goal, radius=DOG.radius).status == "complete"

    def room_to_turn(self, points, length):
        return self.graph.room_to_turn(points, length)


def dead_end(width):
    """A room x < 0, and a passage of 2 m off it, closed at x = 2."""
    half = width / 2
    loop = [(-4, -3), (0, -3), (0, -half), (2, -half), (2, half), (0, half), (0, 3), (-4, 3)]
    return quads(floor(), *(wall(a, b) for a, b in zip(loop, loop[1:] + loop[:1], strict=True)))
