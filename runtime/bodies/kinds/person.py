"""People: simulated under physics, with learned skills."""

from collections.abc import Mapping

import numpy as np

import navmesh
from locomotion import PERSON_RULES, Human
from locomotion.recorded.skeletons import LEVELS
from locomotion.skills.interface import skill_ranges
from runtime.bodies.figure import Figure
from runtime.bodies.kinds.kind import BodyKind, Surroundings
from runtime.bodies.people import People
from runtime.bodies.persons import Persons
from runtime.bodies.protocol import Driver, Population
from runtime.bodies.recorded import Recorded

__all__ = ["PersonKind", "person_rules"]


def person_rules() -> navmesh.WalkRules:
    """Where a person can go."""
    return navmesh.WalkRules(**{name: value for name, value in PERSON_RULES.items() if name != "radius"})


class PersonKind(BodyKind):
    """A person."""

    names = ("human",)
    levels = ("physics", *LEVELS)
    uses_skill_files = True
    bot_speed = 3.3

    def noun(self, body: str) -> str:
        return "person"

    def radius(self, body: str) -> float:
        return PERSON_RULES["radius"]

    def walk_rules(self, body: str) -> navmesh.WalkRules:
        return person_rules()

    def figure(self, body: str) -> Figure:
        return Figure.from_model(Human().model)

    def bot_skills(self, body: str) -> Mapping[str, tuple[float, float]]:
        return skill_ranges(Human().clearing)

    def spawn(
        self, population: Population, body: str, place: np.ndarray, facing: float, radius: float, level: str
    ) -> Driver:
        assert isinstance(population, Persons)
        if level not in LEVELS:
            return population.spawn(body, place, facing, radius)
        return population.spawn_recorded(body, place, facing, radius, level)

    def populate(self, around: Surroundings) -> Population:
        physical = People(
            around.level,
            around.skills,
            around.rehearsals,
            around.seed,
            around.walk,
            around.rehearsal_ticks,
            around.threads,
        )
        return Persons(physical, Recorded(around.level, around.populations, around.seed))
