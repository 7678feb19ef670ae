"""Which obstacle a mission's `use` means, and from where to where the agent clears it."""

import numpy as np

import navmesh
from locomotion.skills.registry import skill_called, skill_kind
from navmesh.obstacles.kinds import kind_of
from navmesh.obstacles.obstacles import Obstacles
from runtime.missions.mission import Address, LoadedMission
from runtime.missions.model import Use
from runtime.world.agent import Agent
from runtime.world.world import World

__all__ = ["find_clearing"]

_RUN_UP = 8.0  # [m] straight at the obstacle, where there is room
_BEYOND = 5.0  # [m] that it goes on behind the edge
_MARGIN = 0.6  # [m] that both keep from the end of the free length
_AROUND = 30.0  # [m] of an open world that have to be known to find an obstacle and its run-up
_NEAR = 3.0  # [m] from the place that `use` names to the obstacle it means


def find_clearing(
    loaded: LoadedMission, world: World, agent: Agent, address: Address, use: Use
) -> np.ndarray:
    """The beginning of the run-up and the place beyond the obstacle of ``use``, (2, 3) [m].

    Raises `FileError` for a skill that the body has not, an obstacle that is not there, is
    too high or too low, and one that the way leads around.
    """
    kind = skill_called(use.skill).obstacle
    if kind.affordance not in agent.skills:
        valid = ", ".join(repr(skill_kind(each).skill) for each in agent.skills) or "none"
        raise loaded.error((*address, "skill"), f"a {agent.body} has no skill {use.skill!r}; valid: {valid}")
    graph = _graph_there(loaded, world, address, use)
    obstacles = graph.obstacles
    index = _obstacle(loaded, obstacles, address, use)
    low, high = agent.skills[kind.affordance]
    size = float(obstacles.size[index])
    if not low <= size <= high:
        measure = "wide" if kind.measure == "width" else "high"
        raise loaded.error(
            address, f"{obstacles.tag[index]} is {size:.2f} m {measure}; {agent.name} can {use.skill} "
            f"{low:.2f} to {high:.2f} m",
        )  # fmt: skip
    before, beyond = _ends(obstacles, index)
    route = graph.find_path(before, beyond, radius=agent.radius, skills=agent.skills)
    if route.status != "complete" or index not in [link.obstacle for link in route.links]:
        raise loaded.error(
            address, f"from before {obstacles.tag[index]} the shortest way does not lead over it"
        )
    return np.array([before, beyond])


def _graph_there(loaded: LoadedMission, world: World, address: Address, use: Use) -> navmesh.NodeGraph:
    """The graph with the obstacle of ``use``; of an open world that of what is around it."""
    if not loaded.open_world:
        return world.graph
    if use.near is None:
        raise loaded.error(
            (*address, "obstacle"),
            f"obstacles of an open world have no names; say near: [x, y, z], at most {_NEAR:g} m from the "
            "middle of its edge",
        )
    there = navmesh.OpenWorld(loaded.level_path, _AROUND)
    there.keep_around(loaded.point(use.near), len(there.chunks))
    return there.graph or world.graph


def _obstacle(loaded: LoadedMission, obstacles: Obstacles, address: Address, use: Use) -> int:
    affordance = skill_called(use.skill).affordance
    if use.near is not None:
        place = loaded.point(use.near)
        index, away = obstacles.near(place, affordance)
        if away > _NEAR:
            raise loaded.error(
                (*address, "near"), f"no obstacle to {use.skill} lies within {_NEAR:g} m of {place.tolist()}"
            )
        return index
    cleared = obstacles.affordance == affordance
    found = np.flatnonzero(cleared & (obstacles.tag == use.obstacle))
    if len(found) == 0:
        named = obstacles.tag[cleared & obstacles.authored].tolist()
        raise loaded.unknown((*address, "obstacle"), str(use.obstacle), f"obstacle to {use.skill}", named)
    return int(found[0])


def _ends(obstacles: Obstacles, index: int) -> tuple[np.ndarray, np.ndarray]:
    """Points (3,) [m] on the floors before and behind, on the line over the middle of the edge."""
    edge, outward = obstacles.position[index], obstacles.normal[index]
    upward = np.array([0.0, 0.0, 1.0])
    kind = kind_of(str(obstacles.affordance[index]))
    across = float(obstacles.depth[index]) if kind.has_depth else 0.0
    run_up = np.clip(obstacles.run_up[index] - _MARGIN, 0.5, _RUN_UP)
    landing = np.clip(obstacles.landing[index] - _MARGIN, 0.5, _BEYOND)
    floor = edge - upward * (obstacles.height[index] if kind.from_below else 0.0)
    return floor + outward * run_up, floor + upward * obstacles.rise[index] - outward * (across + landing)
