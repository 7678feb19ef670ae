"""What a kind of body has to say of itself. Methods that are not abstract do what most kinds need."""

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import navmesh
from runtime.bodies.figure import Figure
from runtime.bodies.populations import Populations
from runtime.bodies.protocol import Driver, Population
from runtime.dis.enumerations import CATEGORY_CIVILIAN, EntityType, life_form_type
from runtime.planning.level import Level
from runtime.traffic.traffic import Traffic

__all__ = ["WALKS", "BodyKind", "Surroundings"]

WALKS = ("learned", "planned")
"""How people walk where the ground is level; everywhere else as planned."""


@dataclass(frozen=True)
class Surroundings:
    """What a world has for its populations.

    ``level`` is the same object through all changes of the level. ``populations``: all of the world, in the
    order in which they are advanced; complete once the world is made. ``skills``: descriptions of skills of
    the user's own; ``rehearsals``, ``rehearsal_ticks``, ``threads``, ``walk``: as of `runtime.World`;
    ``seed``: the world's.
    """

    level: Level
    traffic: Traffic
    populations: Populations
    skills: tuple[Path, ...]
    rehearsals: int
    rehearsal_ticks: int | None
    threads: int
    seed: int
    walk: str


class BodyKind(ABC):
    """A kind of body, of one or several ``names``: what `World.spawn`, missions, playtests and servers call
    its bodies. Everything that is asked of a body by its name is asked here."""

    names: tuple[str, ...]
    files = ""
    """What its body files are called in messages; empty if it has none."""
    spawned = True
    """Whether hosts spawn its bodies. Those of other kinds come in from elsewhere, see `World.admit`, and
    `body_names` leaves them out."""
    sized = False
    """Whether `World.spawn` can give its bodies another radius."""
    uses_skill_files = False
    """Whether skills of the user's own change what its bodies do."""
    levels = ("physics",)
    """Levels of detail that its bodies can have."""
    avoids_all = False
    """Whether its bodies go by where all others are: they are advanced last."""
    slides_as_bot = False
    """Whether the bots of a playtest are capsules that `runtime.playtest` slides over the triangles, and not
    bodies of a world."""
    bot_speed = 1.5
    """[m/s] of its bots."""

    def takes_file(self, body: str) -> bool:
        """Whether ``body`` is the path of a file that describes a body of this kind."""
        return False

    def check(self, body: str) -> None:  # noqa: B027  most have no files
        """Raises `RuntimeInputError` for a body file with a mistake. ``body`` is one of `names` or was
        taken by `takes_file`, here and below."""

    def noun(self, body: str) -> str:
        """What sentences call it."""
        return Path(body).stem

    @abstractmethod
    def radius(self, body: str) -> float:
        """[m] that the graph's queries keep free around it, unless it is given another."""

    @abstractmethod
    def walk_rules(self, body: str) -> navmesh.WalkRules:
        """Where it can go."""

    @abstractmethod
    def figure(self, body: str) -> Figure:
        """What it looks like."""

    def bot_skills(self, body: str) -> Mapping[str, tuple[float, float]]:
        """For each affordance that a bot can clear the least and the greatest size [m]."""
        return {}

    def spawn(
        self, population: Population, body: str, place: np.ndarray, facing: float, radius: float, level: str
    ) -> Driver:
        """A body of it in its ``population``, at one of its `levels`."""
        return population.spawn(body, place, facing, radius)

    def entity_type(self, body: str) -> EntityType:
        """What it is for other simulators: the entity type of DIS."""
        return life_form_type(CATEGORY_CIVILIAN)

    @abstractmethod
    def populate(self, around: Surroundings) -> Population:
        """All its bodies in a world that is being made; nobody yet."""
