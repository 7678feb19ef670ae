"""Who plays: the size of a body and what it can clear, as the analysis and the bots take it."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import navmesh
from locomotion import PERSON_RULES, Human
from locomotion.quadruped import BODY_NAMES, load_body
from locomotion.skills.interface import skill_ranges
from runtime.errors import RuntimeInputError
from runtime.planning.rules import obstacle_rules, walk_rules

__all__ = ["BODIES", "Character", "changed", "character_of"]

BODIES = ("walker", "human", *BODY_NAMES)
"""What a bot can be: the walker is a quick kinematic capsule, the others are the bodies of a world."""


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
        return "person" if self.body in ("human", "walker") else self.body

    @property
    def stride(self) -> float:
        """[m] gaps in the floor up to this are stepped over: two thirds of the body's width."""
        return 2.0 * self.radius * 2.0 / 3.0

    def obstacle_rules(self) -> navmesh.ObstacleRules:
        """What counts as an obstacle for it: all that it can clear, and the usual rest."""
        return obstacle_rules(self.skills, max(self.radius, 0.05))

    def reach(self, affordance: str) -> float:
        """The greatest height (width) of ``affordance`` that it clears [m]; 0 without the skill."""
        return self.skills.get(affordance, (0.0, 0.0))[1]

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
    """The character that ``body`` of `BODIES` is by itself. Raises `RuntimeInputError` for another name."""
    if body not in BODIES:
        raise RuntimeInputError(f"body {body!r}: valid: {', '.join(map(repr, BODIES))}")
    if body == "human":
        skills = skill_ranges(Human().clearing)
        return Character(body, PERSON_RULES["radius"], 3.3, walk_rules(["human"]), skills)
    if body == "walker":
        rules = walk_rules(["human"])
        low = rules.max_step
        skills = {"jump": (low, 0.7), "vault": (0.6, 1.0), "drop": (low, 2.0), "gap": (0.4, 2.5)}
        return Character(body, PERSON_RULES["radius"], 3.0, rules, skills)
    kind = load_body(body)
    return Character(body, kind.radius, 1.5, kind.walk_rules(), {})


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
