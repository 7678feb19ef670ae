"""How a recorded person gets over the obstacles on its way: it runs up, plays a recorded skill, goes on.

Between obstacles it moves as a walker does. From the run-up on it is moved along the line over the obstacle,
and others keep out of its way; where it lands it is a walker again.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from locomotion.body.traits import SIZE
from locomotion.body_events import Cleared, Event, GotStuck, LostGround, TookOff
from locomotion.crowd import Crowd, NoRoute, Walker
from locomotion.recorded.motion_set import MotionSet
from locomotion.recorded_people import layout as at
from locomotion.recorded_people.clearing import RecordedSkill
from locomotion.recorded_people.crossing import Crossing

__all__ = ["ObstacleCourse"]

_NEAR = 0.9  # [m] before an obstacle's run-up point at which a run-up begins
_TURNS = 6.0  # [rad/s] at most, meanwhile
_ABREAST = 1.2  # [m] between two who clear an obstacle side by side
_PATIENCE = 10.0  # [s] for which one waits for others before an obstacle


class Person(Protocol):
    """What a course asks of its person; members: as of `locomotion.recorded_people.person.RecordedPerson`."""

    walker: Walker
    crossing: Crossing | None

    @property
    def index(self) -> int: ...
    @property
    def row(self) -> NDArray[np.float64]: ...
    @property
    def phase(self) -> float: ...
    @property
    def time(self) -> float: ...
    @property
    def point(self) -> tuple[float, float, float]: ...
    @property
    def events(self) -> list[Event]: ...
    @property
    def qpos(self) -> NDArray[np.float64]: ...
    @property
    def qpos_rates(self) -> NDArray[np.float64]: ...
    def change(self, what: Callable[[], object]) -> None: ...
    def set_out(self, points: NDArray[np.float64], speed: float, facing: float | None) -> object: ...
    def go_on_from(
        self,
        pose: NDArray[np.float64],
        pose_rates: NDArray[np.float64],
        place: NDArray[np.float64],
        velocity: NDArray[np.float64],
    ) -> None: ...


class People(Protocol):
    """What it asks of all; members: as of `locomotion.recorded_people.people.RecordedPeople`."""

    crowd: Crowd
    motions: MotionSet
    skills: dict[str, RecordedSkill]
    dt: float

    @property
    def rows(self) -> NDArray[np.float64]: ...
    @property
    def people(self) -> Sequence[Person]: ...
    def cadence(self, index: int) -> float: ...


class ObstacleCourse:
    """A person's obstacles, one after the other: ``RecordedPerson.crossing``."""

    def __init__(self, person: Person, people: People) -> None:
        self._person, self._people = person, people

    @property
    def of(self) -> Crossing:
        """The obstacle that is next, or under way."""
        crossing = self._person.crossing
        assert crossing is not None
        return crossing

    def move_on(self, dt: float) -> None:
        """Be moved over an obstacle in the next ``dt`` [s], in which bodies move once."""
        people, of = self._people, self.of
        skill, then = people.skills[of.affordance], self._person.time - of.begun + dt
        here = self._person.walker.position
        if self._person.row[at.CROSSES] == at.RUNS_UP:
            point = skill.run_up(of, then)[0]
            cadence = people.cadence(self._person.index) / self._person.row[at.HASTE]
            haste = skill.haste(of, then - dt, self._person.phase, cadence)
            self._person.row[at.HASTE] = self._person.row[at.HASTE] if haste is None else haste
            cells, floors = people.crowd.graph.project(np.array([[*point, here[2]]]))
            place = np.array([*point, floors[0] if cells[0] >= 0 else here[2]])
        else:
            place = skill.place(people.motions, of, skill.moment(of, then + self._flown))
        turn = (of.heading - self._person.walker.yaw + np.pi) % (2.0 * np.pi) - np.pi
        yaw = self._person.walker.yaw + float(np.clip(turn, -_TURNS * dt, _TURNS * dt))
        self._person.walker.carry(place, (place - here)[:2] / dt, (yaw + np.pi) % (2.0 * np.pi) - np.pi)

    @property
    def _flown(self) -> float:
        """[s] to be added to the time since the run-up began for that since the skill did."""
        of = self.of
        return self._people.skills[of.affordance].run_up(of, 0.0)[2] * -1.0

    def moment(self, now: float) -> float:
        """[s] of the recording that is played at the time ``now`` [s], over an obstacle."""
        of = self.of
        return self._people.skills[of.affordance].moment(of, now - of.begun + self._flown)

    def pose(self, now: float) -> NDArray[np.float64]:
        """(46,) its pose at the time ``now`` [s], over an obstacle."""
        people, of = self._people, self.of
        skill = people.skills[of.affordance]
        moment = self.moment(now)
        row = self._person.row
        return skill.pose(people.motions, int(row[at.LEVEL]), of, moment, float(row[at.TRAITS][SIZE]))

    def on_its_hands(self, pose: NDArray[np.float64], now: float) -> NDArray[np.float64]:
        """``pose`` (46,) at the time ``now`` [s], over an obstacle, with hands on that which rest on it."""
        people, of, row = self._people, self.of, self._person.row
        skill = people.skills[of.affordance]
        moment = self.moment(now)
        look = int(row[at.LEVEL]), float(row[at.TRAITS][SIZE])
        return skill.on_its_hands(people.motions, of, moment, pose, look)

    def floor(self, now: float) -> tuple[float, float] | None:
        """As `RecordedSkill.floor` at the time ``now`` [s], of one over an obstacle."""
        if self._person.row[at.CROSSES] != at.CLEARS:
            return None
        of = self.of
        skill = self._people.skills[of.affordance]
        return skill.floor(of, self.moment(now))

    def cross(self) -> None:
        """After bodies have moved: begin a run-up, take off, or go on behind the obstacle."""
        people, of = self._people, self.of
        skill, elapsed = people.skills[of.affordance], self._person.time - of.begun
        if self._person.row[at.CROSSES] == at.APPROACHES:
            self._begin_run_up(of)
        elif self._person.row[at.CROSSES] == at.RUNS_UP:
            if elapsed + self._flown >= 0.0:
                self._person.events.append(
                    TookOff(self._person.time, self._person.point, of.affordance, of.size, 0.0, 0.0)
                )
                self._person.change(self._take_off)
        elif elapsed + self._flown >= skill.seconds(of):
            self._land(of)

    def stay(self) -> None:
        """After its body has moved: if it has come to where its run-up begins, it has not arrived. It waits
        there for its turn."""
        walker = self._person.walker
        if walker.status == "arrived":
            walker.events.pop()
            walker.status = "walking"

    def give_up(self) -> None:
        """Its obstacle has gone before it took off: go on from here to what it was told."""
        of = self.of
        if self.break_off():
            self._go_on(of)

    def break_off(self) -> bool:
        """Leave a run-up; whether there is a floor under it. If not, it has lost its ground."""
        person = self._person
        person.crossing, person.row[at.CROSSES], person.row[at.HASTE] = None, at.NOTHING, 1.0
        on_floor = person.walker.put_down()
        if not on_floor:
            self._lose_ground()
        return on_floor

    def _begin_run_up(self, of: Crossing) -> None:
        people, walker = self._people, self._person.walker
        if walker.status == "stuck":
            self._person.crossing, self._person.row[at.CROSSES] = None, at.NOTHING
            return
        pace = float(np.hypot(*walker.velocity))
        goals_before = len(people.crowd.goals_left(self._person.index)) > 1
        far = max(_NEAR, pace * pace / (2.0 * 0.8 * walker.acceleration) + 0.3)
        if walker.status == "walking" and (goals_before or walker.left > far):
            return
        if self._waits_for_others(of):
            self._person.crossing = replace(of, waited=of.waited + people.crowd.dt)
            return
        skill, graph = people.skills[of.affordance], people.crowd.graph
        x, y, z = walker.position.tolist()
        self._person.crossing = replace(of, begun=self._person.time, origin=(x, y, z, pace))
        ends = skill.place(people.motions, self._person.crossing, skill.ends)
        cells, floors = graph.project(ends[None])
        roomy = cells[0] >= 0 and abs(floors[0] - of.end[2]) < graph.rules.max_step
        if not (roomy and graph.clearance_at(ends) >= walker.radius):
            self._person.crossing = replace(self._person.crossing, last=math.dist(of.edge[:2], of.end[:2]))
        self._person.row[at.CROSSES] = at.RUNS_UP

    def _waits_for_others(self, of: Crossing) -> bool:
        """Whether others are about to clear the same, or stand where it would land."""
        if of.waited > _PATIENCE:
            return False
        people, mine = self._people, self._person.index
        for index in np.flatnonzero(people.rows[:, at.CROSSES] >= at.RUNS_UP).tolist():
            other = people.people[index].crossing
            if other is not None and math.dist(other.edge, of.edge) < _ABREAST:
                return True
        places = people.crowd.places_of_all
        away = np.linalg.norm(places - np.array(of.end), axis=1)
        away[mine] = np.inf
        return bool((away < 2.0 * self._person.walker.radius).any())

    def _take_off(self) -> None:
        self._person.row[at.CROSSES], self._person.row[at.LAID], self._person.row[at.GAIT] = (
            at.CLEARS,
            0.0,
            -1.0,
        )
        self._person.row[at.HASTE] = 1.0

    def _land(self, of: Crossing) -> None:
        walker = self._person.walker
        pose, pose_rates = self._person.qpos, self._person.qpos_rates
        velocity = walker.velocity
        landed = walker.put_down()
        if not landed:
            walker.carry(np.array(of.end), velocity, walker.yaw)
            landed = walker.put_down()
        self._person.crossing, self._person.row[at.CROSSES] = None, at.NOTHING
        self._person.go_on_from(pose, pose_rates, walker.position, velocity)
        self._person.events.append(Cleared(self._person.time, self._person.point, of.affordance, of.size))
        if landed:
            self._go_on(of)
        else:
            self._lose_ground()

    def _lose_ground(self) -> None:
        """There is no floor where it is to go on."""
        self._person.walker.hang()
        self._person.events.append(LostGround(self._person.time, self._person.point))

    def _go_on(self, of: Crossing) -> None:
        """Set out for what it was told, behind or before the obstacle ``of``."""
        walker = self._person.walker
        if not of.goals or self._person.row[at.BUSY] > 0.0:
            walker.stop()
            return
        told = len(self._person.events)
        try:
            self._person.set_out(np.array(of.goals), of.speed, of.facing)
            del self._person.events[told:]
        except NoRoute:
            walker.status = "stuck"
            self._person.events.append(GotStuck(self._person.time, self._person.point))
