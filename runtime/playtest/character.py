"""Who plays: the size of a body and what it can clear, as the analysis and the bots take it."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import navmesh
from locomotion.skills.kind import SkillKind
from locomotion.skills.registry import skill_kinds
from navmesh.obstacles.kinds import Crossing
from runtime.bodies.figure import Figure
from runtime.bodies.registry import body_names, kind_of
from runtime.errors import RuntimeInputError
from runtime.planning.rules import obstacle_rules

__all__ = ["Character", "changed", "character_of"]


@dataclass(frozen=True)
class Character:
    """A body that plays. Lengths in metres.

    ``skills`` maps an affordance to the least and greatest height (of a gap: width) that the body clears;
    ``rules`` are the walk rules that suit it; ``speed`` [m/s] is how fast it goes.
    """

    body: str
    radius: float
    speed: float
    rules: navmesh.WalkRules
    skills: Mapping[str, tuple[float, float]]

    @property
    def noun(self) -> str:
        """What sentences call it."""
        return kind_of(self.body).noun(self.body)

    @property
    def slides(self) -> bool:
        """Whether it is a quick capsule that slides over the triangles, and no body of a world."""
        return kind_of(self.body).slides_as_bot

    def figure(self) -> Figure:
        """What its body looks like in a world."""
        return kind_of(self.body).figure(self.body)

    @property
    def stride(self) -> float:
        """[m] gaps in the floor up to this are stepped over: two thirds of the body's width."""
        return 2.0 * self.radius * 2.0 / 3.0

    def obstacle_rules(self) -> navmesh.ObstacleRules:
        """What counts as an obstacle for it: all that it can clear, and the usual rest."""
        return obstacle_rules(self.skills, max(self.radius, 0.05))

    def clears(self, crossing: Crossing) -> list[tuple[SkillKind, float, float]]:
        """With what it gets past obstacles in this way, from and up to which size [m]."""
        return [
            (kind, *self.skills[kind.affordance])
            for kind in skill_kinds()
            if kind.obstacle.crossing == crossing and self.skills.get(kind.affordance, (0.0, 0.0))[1] > 0.0
        ]

    def span(self, crossing: Crossing) -> tuple[float, float]:
        """Least and greatest size [m] that it gets past in this way; (0, 0) if it does not."""
        ranges = [limits for _, *limits in self.clears(crossing)]
        return (min(low for low, _ in ranges), max(high for _, high in ranges)) if ranges else (0.0, 0.0)

    def reach(self, crossing: Crossing) -> float:
        """The greatest size [m] that it gets past in this way; 0 if it does not."""
        return self.span(crossing)[1]

    def to_dict(self) -> dict[str, Any]:
        """As plain values, for a report."""
        return {
            "body": self.body,
            "radius": self.radius,
            "speed": self.speed,
            "rules": self.rules.to_dict(),
            "skills": {name: list(limits) for name, limits in self.skills.items()},
        }


def character_of(body: str) -> Character:
    """The character that a body of `runtime.bodies.registry.body_names` is by itself. Raises
    `RuntimeInputError` for another name."""
    if body not in body_names():
        raise RuntimeInputError(f"body {body!r}: valid: {', '.join(map(repr, body_names()))}")
    kind = kind_of(body)
    return Character(body, kind.radius(body), kind.bot_speed, kind.walk_rules(body), kind.bot_skills(body))


def changed(character: Character, radius: float | None, speed: float | None, rules: Mapping[str, float],
            skills: Mapping[str, tuple[float, float]] | None) -> Character:  # fmt: skip
    """``character`` with what a playtest file says of it; ``rules`` are walk rules by name."""
    walking = navmesh.WalkRules(**{**character.rules.to_dict(), **rules})
    return replace(
        character,
        radius=character.radius if radius is None else radius,
        speed=character.speed if speed is None else speed,
        rules=walking,
        skills=character.skills if skills is None else dict(skills),
    )
