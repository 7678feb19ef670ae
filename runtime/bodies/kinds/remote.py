"""Figures that other simulators move."""

import navmesh
from runtime.bodies.figure import Figure
from runtime.bodies.kinds.kind import BodyKind, Surroundings
from runtime.bodies.kinds.person import person_rules
from runtime.bodies.protocol import Population
from runtime.bodies.remote_figures import RemoteFigures
from runtime.bodies.remote_looks import PERSON, look_of

__all__ = ["RemoteKind"]


class RemoteKind(BodyKind):
    """A figure of another simulator, of whatever look; see `runtime.dis`."""

    names = ("remote",)
    spawned = False

    def noun(self, body: str) -> str:
        return "remote figure"

    def radius(self, body: str) -> float:
        return look_of(PERSON).radius

    def walk_rules(self, body: str) -> navmesh.WalkRules:
        return person_rules()

    def figure(self, body: str) -> Figure:
        return look_of(PERSON).figure

    def populate(self, around: Surroundings) -> Population:
        return RemoteFigures(around.level)
