"""Walkers: cheap bodies of any radius, by the thousand."""

from collections.abc import Mapping

import navmesh
from locomotion import PERSON_RULES
from locomotion.skills.registry import skill_kinds
from runtime.bodies.figure import Figure
from runtime.bodies.kinds.kind import BodyKind, Surroundings
from runtime.bodies.kinds.person import person_rules
from runtime.bodies.protocol import Population
from runtime.bodies.walkers import Walkers, walker_figure

__all__ = ["WalkerKind"]


class WalkerKind(BodyKind):
    """A walker, by default of a person's size. As a bot it clears obstacles, in a world it does not."""

    names = ("walker",)
    sized = True
    avoids_all = True
    slides_as_bot = True
    bot_speed = 3.0

    def noun(self, body: str) -> str:
        return "person"

    def radius(self, body: str) -> float:
        return PERSON_RULES["radius"]

    def walk_rules(self, body: str) -> navmesh.WalkRules:
        return person_rules()

    def figure(self, body: str) -> Figure:
        return walker_figure(self.radius(body))

    def bot_skills(self, body: str) -> Mapping[str, tuple[float, float]]:
        return _all_that_is_found(self.walk_rules(body).max_step)

    def populate(self, around: Surroundings) -> Population:
        return Walkers(around.level, around.populations)


def _all_that_is_found(step: float) -> dict[str, tuple[float, float]]:
    """The sizes [m] of every kind that are looked for, or that people are to clear; what a body gets onto or
    off it clears from ``step`` [m] on."""
    skills, usual = {}, navmesh.ObstacleRules()
    for kind in skill_kinds():
        low, high = usual.range_of(kind.obstacle) or kind.sizes
        skills[kind.affordance] = (low if kind.obstacle.has_depth else step, high)
    return skills
