"""Quadrupeds: those that come with the package, and those of body files."""

import navmesh
from locomotion import LocomotionError
from locomotion.quadruped import BODY_NAMES, is_body_file, load_body
from runtime.bodies.animal_figure import animal_figure
from runtime.bodies.figure import Figure
from runtime.bodies.kinds.kind import BodyKind, Surroundings
from runtime.bodies.protocol import Population
from runtime.bodies.quadrupeds import Pack
from runtime.dis.enumerations import CATEGORY_MAMMAL, EntityType, life_form_type
from runtime.errors import RuntimeInputError

__all__ = ["QuadrupedKind"]


class QuadrupedKind(BodyKind):
    """A quadruped, of the body that `locomotion.quadruped.load_body` gives."""

    names = BODY_NAMES
    files = "a quadruped's .yaml file"

    def takes_file(self, body: str) -> bool:
        return is_body_file(body)

    def check(self, body: str) -> None:
        try:
            load_body(body)
        except LocomotionError as error:
            raise RuntimeInputError(str(error)) from None

    def radius(self, body: str) -> float:
        return load_body(body).radius

    def walk_rules(self, body: str) -> navmesh.WalkRules:
        return load_body(body).walk_rules()

    def figure(self, body: str) -> Figure:
        return animal_figure(load_body(body))

    def entity_type(self, body: str) -> EntityType:
        """A mammal; ``extra``, which is ours to define, says which of our own, 0 for others."""
        return life_form_type(CATEGORY_MAMMAL, BODY_NAMES.index(body) + 1 if body in BODY_NAMES else 0)

    def populate(self, around: Surroundings) -> Population:
        return Pack(around.level, around.traffic, around.seed)
