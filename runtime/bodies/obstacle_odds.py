"""The odds of a person at the obstacles of a level, and what they make of its links."""

import numpy as np

import navmesh
from locomotion import ObstacleAhead
from locomotion.gaits.limits import PERSON_RULES
from locomotion.human.sized_human import SizedHuman
from locomotion.paths.run_up_room import straight_before
from locomotion.preconditions.features import MOST_ROOM
from locomotion.skills.interface import skill_for, skill_ranges
from navmesh.obstacles.kinds import kind_of
from navmesh.recent import recent
from runtime.errors import RuntimeInputError
from surefoot.numeric import is_whole

__all__ = ["link_prices", "odds_at"]

_FAILING = 30.0  # [m] of way that a failed try is worth: a fall, getting up, and another run-up
_LEAST = 0.01  # odds that lower ones count as


def link_prices(body: SizedHuman, graph: navmesh.NodeGraph) -> np.ndarray:
    """(l,) [m] by which the chance of failing makes each link of ``graph`` dearer for the person ``body``:
    with odds of p, (1 - p) / p tries fail before one holds. 0 where nothing is known of the skill. Worked out
    once for each graph."""
    human, size = body.human, body.size
    known = [(skill, human.composition.precondition(skill)) for skill in human.clearing]
    grip = human.composition.grip

    def make() -> np.ndarray:
        links, prices = graph.links, np.zeros(len(graph.links))
        room = straight_before(graph, PERSON_RULES["radius"], size * MOST_ROOM)
        for skill, precondition in known:
            if precondition is None:
                continue
            low, high = skill_ranges([skill])[skill.affordance]
            those = links.affordance == skill.affordance
            those &= (links.height >= size * low) & (links.height <= size * high)
            depth = graph.obstacles.depth[links.obstacle[those]] * kind_of(skill.affordance).has_depth
            own = np.column_stack([links.height[those], depth, room[those]]) / size
            rows = np.insert(own, 2, grip, axis=1)
            odds = np.maximum(precondition.odds_before(rows), _LEAST)
            prices[those] = _FAILING * (1.0 - odds) / odds
        return prices

    blocked = b"" if graph.zone_state is None else graph.zone_state.blocked.tobytes()
    digests = tuple(None if each is None else (each.digest, skill.heights) for skill, each in known)
    return recent(graph.cache, "link_prices", (digests, size, grip, blocked), make)


def odds_at(body: SizedHuman, graph: navmesh.NodeGraph, obstacle: int | str, tag_ahead: str) -> float:
    """Chance, 0 to 1, that the person ``body`` clears an ``obstacle`` of ``graph`` from where it is; see
    `runtime.Agent.odds`. ``tag_ahead``: of the next one on its way."""
    number = _number_of(graph, obstacle)
    obstacles = graph.obstacles
    normal, position = obstacles.normal[number], obstacles.position[number]
    away, human = body.position - position, body.human
    asked = ObstacleAhead(
        max(float(away[:2] @ normal[:2]), 0.0), str(obstacles.affordance[number]),
        float(obstacles.height[number]), position, normal, float(obstacles.depth[number]),
    )  # fmt: skip
    own = body.own(asked)
    if skill_for(human.clearing, own) is None:
        return 0.0
    ahead = human.obstacle_ahead
    if ahead is not None and tag_ahead == str(obstacles.tag[number]):
        own = ahead
    odds = human.composition.odds(own, float(np.hypot(away[0], away[1])) / body.size)
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
