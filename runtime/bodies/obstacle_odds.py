"""The odds of a person at an obstacle of the level."""

import numpy as np

import navmesh
from locomotion import Human, ObstacleAhead
from locomotion.skills.interface import skill_for
from runtime.errors import RuntimeInputError
from surefoot.numeric import is_whole

__all__ = ["odds_at"]


def odds_at(human: Human, graph: navmesh.NodeGraph, obstacle: int | str, tag_ahead: str) -> float:
    """Chance, 0 to 1, that ``human`` clears an ``obstacle`` of ``graph`` from where it is; see
    `runtime.Agent.odds`. ``tag_ahead``: of the next one on its way."""
    number = _number_of(graph, obstacle)
    obstacles = graph.obstacles
    normal, position = obstacles.normal[number], obstacles.position[number]
    away = human.position - position
    asked = ObstacleAhead(
        max(float(away[:2] @ normal[:2]), 0.0), str(obstacles.affordance[number]),
        float(obstacles.height[number]), position, normal, float(obstacles.depth[number]),
    )  # fmt: skip
    if skill_for(human.clearing, asked) is None:
        return 0.0
    ahead = human.obstacle_ahead
    if ahead is not None and tag_ahead == str(obstacles.tag[number]):
        asked = ahead
    odds = human.composition.odds(asked, float(np.hypot(away[0], away[1])))
    if odds is None:
        what = f"the {asked.affordance} of {asked.size:.2f} m"
        raise RuntimeInputError(f"no odds are known of the skill with which it clears {what}")
    return odds


def _number_of(graph: navmesh.NodeGraph, obstacle: int | str) -> int:
    tags = graph.obstacles.tag
    if isinstance(obstacle, str):
        found = np.flatnonzero(tags == obstacle)
        if not len(found):
            known = ", ".join(map(str, tags[:8])) or "none"
            raise RuntimeInputError(f"obstacle {obstacle!r}: the level has {len(tags)}: {known}")
        return int(found[0])
    if not is_whole(obstacle) or obstacle >= len(tags):
        raise RuntimeInputError(
            f"obstacle must be a tag or a whole number below {len(tags)}, the level's, not {obstacle!r}"
        )
    return int(obstacle)
