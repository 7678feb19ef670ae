"""How a recorded person takes the postures that it is told to take.

It comes to a stand first, then plays the way through the posture graph. `RecordedPerson.wanted` is what it
was told, `RecordedPerson.playback` what it plays.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from locomotion.body_events import Event, PostureReached
from locomotion.crowd import Walker
from locomotion.errors import LocomotionError
from locomotion.postures.held_objects import STOWED, parts_of
from locomotion.postures.playback import Playback, asked_for, at_rest, settled
from locomotion.postures.posture_graph import PostureGraph
from locomotion.postures.step_order import AT_REST, Gait
from locomotion.recorded_people import layout as at
from locomotion.recorded_people.crossing import Crossing
from locomotion.recorded_people.nodes import checked_node
from locomotion.recorded_people.obstacle_course import ObstacleCourse
from locomotion.recorded_people.person_state import Errand

__all__ = ["PostureOrders"]


class Person(Protocol):
    """What is asked of the person; members: as of `locomotion.recorded_people.person.RecordedPerson`."""

    walker: Walker
    playback: Playback | None
    wanted: str
    errand: Errand | None
    crossing: Crossing | None
    course: ObstacleCourse

    @property
    def index(self) -> int: ...
    @property
    def row(self) -> NDArray[np.float64]: ...
    @property
    def time(self) -> float: ...
    @property
    def point(self) -> tuple[float, float, float]: ...
    @property
    def events(self) -> list[Event]: ...
    def stop(self) -> None: ...
    def change(self, what: Callable[[], object]) -> None: ...
    def set_out(self, points: NDArray[np.float64], speed: float, facing: float | None) -> object: ...


class People(Protocol):
    """What is asked of all; members: as of `locomotion.recorded_people.people.RecordedPeople`."""

    graph: PostureGraph
    gaits: tuple[Gait, ...]
    stand: int

    def lay_feet(self, index: int) -> None: ...


class PostureOrders:
    """A person's orders, one after the other."""

    def __init__(self, person: Person, people: People) -> None:
        self._person, self._people = person, people

    def take(self, posture: str, held: str, state: str) -> None:
        """As `RecordedPerson.take`."""
        person, graph = self._person, self._people.graph
        node = checked_node(graph, posture, held, state)
        fatal = graph.fatal >= 0 and node == graph.postures[graph.fatal]
        if not fatal:
            self.check_way(node)
        if fatal and person.row[at.CROSSES] == at.RUNS_UP:
            person.course.break_off()
        person.stop()
        self.ask(node)
        if fatal and person.playback is None and person.crossing is None:
            self._begin()

    def check_way(self, node: str) -> None:
        """Raise `LocomotionError` if there is no way to the posture ``node`` from where the person is."""
        person, graph = self._person, self._people.graph
        here = person.playback.posture if person.playback is not None else int(person.row[at.NODE])
        if not np.isfinite(graph.least[here, graph.postures.index(node)]):
            raise LocomotionError(f"there is no way from {graph.postures[here]!r} to {node!r}")

    def ask(self, node: str) -> None:
        """Let the person take the posture ``node`` as soon as it stands."""
        person = self._person
        person.wanted, person.errand = node, None
        person.row[at.BUSY] = 1.0
        if person.playback is not None:
            self._begin()

    def _begin(self) -> None:
        """Play the way to the posture that is wanted."""
        person, graph, row = self._person, self._people.graph, self._person.row

        def begin() -> None:
            person.walker.root()
            playback = person.playback or at_rest(graph, graph.postures[int(row[at.NODE])], (0.0, 0.0, 0.0))
            # to the fatal posture it would blend from its last pose, which the fade does already
            person.playback = replace(asked_for(graph, playback, person.wanted, person.time), last=None)
            row[at.GAIT], row[at.SPEED], row[at.LAID] = -1.0, 0.0, 0.0
            row[at.BUSY] = 1.0

        person.change(begin)

    def tick(self) -> None:
        """After the person's body has moved: go on."""
        person, graph = self._person, self._people.graph
        if person.playback is None:
            if np.hypot(*person.walker.velocity) < AT_REST and person.crossing is None:
                self._begin()
            return
        person.playback = playing = settled(graph, person.playback, person.time)
        if playing.arc >= 0 or not person.wanted or playing.posture != playing.target:
            return
        posture, held, state = parts_of(person.wanted, graph.objects)
        holds = "" if state == STOWED else f"{held} {state}"
        person.events.append(PostureReached(person.time, person.point, posture, holds))
        person.wanted = ""
        base = graph.postures.index(posture)
        if any(gait.posture == base for gait in self._people.gaits):
            person.change(lambda: self._rest(playing.posture, base))
        errand, person.errand = person.errand, None
        if errand is not None:
            person.set_out(np.array(errand.goals), errand.speed, errand.facing)

    def _rest(self, node: int, base: int) -> None:
        """Be in the posture ``node``, with free hands ``base``, in which one can move."""
        person = self._person
        person.playback = None
        person.row[at.NODE], person.row[at.BUSY] = node, 0.0
        if base == self._people.stand:
            person.walker.stop()
            self._people.lay_feet(person.index)
