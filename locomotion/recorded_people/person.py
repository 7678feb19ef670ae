"""One recorded person: its way, its posture, what its hands hold."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from locomotion.body_events import Event, SetOff
from locomotion.crowd import Crowd, Walker
from locomotion.postures.held_objects import node_name, parts_of
from locomotion.postures.playback import Playback
from locomotion.postures.posture_graph import PostureGraph
from locomotion.postures.step_order import Gait
from locomotion.recorded.motion_set import MotionSet
from locomotion.recorded_people import layout as at
from locomotion.recorded_people.clearing import RecordedSkill
from locomotion.recorded_people.crossing import Crossing, crossing_of
from locomotion.recorded_people.fading import STEP, Fade, fade_from, rates
from locomotion.recorded_people.obstacle_course import ObstacleCourse
from locomotion.recorded_people.person_state import Errand, PersonState, digest
from locomotion.recorded_people.posture_orders import PostureOrders
from locomotion.recorded_people.taking_over import go_on_from
from locomotion.skills.registry import skill_kind
from navmesh.routes.route import Route

__all__ = ["RecordedPerson"]


class ItsPeople(Protocol):
    """What a person asks of all; members: as of `locomotion.recorded_people.people.RecordedPeople`."""

    crowd: Crowd
    turns: NDArray[np.float64]
    graph: PostureGraph
    gaits: tuple[Gait, ...]
    stand: int
    bases: NDArray[np.int64]
    dt: float
    motions: MotionSet
    skills: dict[str, RecordedSkill]
    ranges: dict[str, tuple[float, float]]

    @property
    def rows(self) -> NDArray[np.float64]: ...
    def row(self, index: int) -> NDArray[np.float64]: ...
    def qpos(self, indices: NDArray[np.int64], ahead: float = 0.0) -> NDArray[np.float64]: ...
    @property
    def people(self) -> Sequence[RecordedPerson]: ...
    def cadence(self, index: int) -> float: ...
    def lay_feet(self, index: int) -> None: ...
    def lay_feet_of(self, index: int, pose: NDArray[np.float64]) -> None: ...
    def begin_at(self, index: int, place: NDArray[np.float64], velocity: NDArray[np.float64]) -> None: ...


class RecordedPerson:
    """``walker``: its body. ``playback``: what it plays of its postures, None while it stands or moves.
    ``wanted``: the posture that it was asked for last and is not in yet, with what is held; "" if none."""

    def __init__(self, people: ItsPeople, walker: Walker) -> None:
        self._people, self.walker = people, walker
        self.playback: Playback | None = None
        self.wanted = ""
        self.errand: Errand | None = None
        self.crossing: Crossing | None = None
        self.course = ObstacleCourse(self, people)
        self._orders = PostureOrders(self, people)

    @property
    def index(self) -> int:
        """Its row."""
        return self.walker.index

    @property
    def row(self) -> NDArray[np.float64]:
        """(`layout.ROW`,) what is remembered of it; a view."""
        return self._people.row(self.walker.index)

    @property
    def turn(self) -> float:
        """When it is drawn anew, as a share of the time between two drawings, 0 to 1."""
        return float(self._people.turns[self.walker.index])

    @property
    def phase(self) -> float:
        """Of its gait's cycle, 0 to 1, from the right foot's strike."""
        late = float(self.row[at.LATE])
        return (float(self.row[at.PHASE]) + late * self._people.cadence(self.index)) % 1.0

    @property
    def time(self) -> float:
        """[s] since it was made."""
        return float(self.row[at.AGE]) * self._people.dt

    @property
    def position(self) -> NDArray[np.float64]:
        """(3,) float64 [m]: the floor point at which it is drawn."""
        return self.row[at.PLACE][:3].copy()

    @property
    def yaw(self) -> float:
        """[rad, -π to π] in which it is drawn to face."""
        return float((self.row[at.PLACE][3] + np.pi) % (2.0 * np.pi) - np.pi)

    @property
    def events(self) -> list[Event]:
        """In order of time."""
        return self.walker.events

    @property
    def node(self) -> str:
        """The posture that it is in or on its way to, with what its hands hold."""
        graph = self._people.graph
        number = int(self.row[at.NODE]) if self.playback is None else self.playback.target
        return self.wanted or graph.postures[number]

    @property
    def posture(self) -> str:
        """The posture that it is in or on its way to."""
        return parts_of(self.node, self._people.graph.objects)[0]

    @property
    def held(self) -> tuple[str, str]:
        """What its hands hold, and the state of that; ("", "stowed") with free hands."""
        return parts_of(self.node, self._people.graph.objects)[1:]

    @property
    def has_free_hands(self) -> bool:
        """Whether it stands or moves with nothing in its hands, and is not asked for anything else."""
        free = self.row[at.BUSY] == 0.0 and self.row[at.CROSSES] < at.RUNS_UP
        return bool(free and int(self.row[at.NODE]) == self._people.stand)

    @property
    def status(self) -> str:
        """ "standing", "walking", "running", "arrived" or "stuck", or what it does over an obstacle, such as
        "jumping"."""
        if self.errand is not None:
            return "walking"
        row, status = self.row, self.walker.status
        if row[at.CROSSES] >= at.RUNS_UP:
            assert self.crossing is not None
            clears = row[at.CROSSES] == at.CLEARS
            return skill_kind(self.crossing.affordance).status if clears else "running"
        if status == "walking" and row[at.GAIT] >= 0.0:
            return "running" if self._people.gaits[int(row[at.GAIT])].name == "run" else status
        return status

    @property
    def qpos(self) -> NDArray[np.float64]:
        """(46,) float64: its pose now."""
        return self.qpos_at(0.0)

    def qpos_at(self, ahead: float) -> NDArray[np.float64]:
        """(46,) float64: its pose ``ahead`` [s] of now if all goes on as it does."""
        return self._people.qpos(np.array([self.index]), ahead)[0]

    @property
    def qpos_rates(self) -> NDArray[np.float64]:
        """(45,) float64: how fast its pose changes, as `fading.rates`."""
        return rates(self.qpos_at(-STEP), self.qpos_at(0.0), STEP)

    # --- what it is told
    def go_to(self, goals: ArrayLike, speed: float, facing: float | None) -> list[Route]:
        """As `Walker.go_to`; one in a posture without a gait that is fast enough stands up first. Raises
        `LocomotionError` for one that cannot get up any more."""
        people = self._people
        points = np.asarray(goals, dtype=np.float64)
        if self.row[at.CROSSES] >= at.RUNS_UP:
            return self._go_on_to(points, speed, facing)
        if self._can_move_at(speed):
            return self.set_out(points, speed, facing)
        target = node_name("stand", *self.held)
        if target not in people.graph.postures:
            target = "stand"
        self._orders.check_way(target)
        routes = people.crowd.find_routes(self.index, points, people.ranges)
        self._orders.ask(target)
        self.errand = Errand(tuple((float(x), float(y), float(z)) for x, y, z in points), speed, facing)
        return routes

    def set_out(self, points: NDArray[np.float64], speed: float, facing: float | None) -> list[Route]:
        """Go through ``points`` (k, 3), as far as the first obstacle on the way."""
        people = self._people
        able = people.ranges if people.bases[int(self.row[at.NODE])] == people.stand else None
        routes = people.crowd.find_routes(self.index, points, able)
        first = next((k for k, route in enumerate(routes) if route.links), None)
        crossing = None
        if first is None:
            self.walker.go_to(points, speed, facing)
        else:
            use = routes[first].links[0]
            goals = tuple((float(x), float(y), float(z)) for x, y, z in points[first:])
            way = sum(route.length for route in routes)
            crossing = crossing_of(people.crowd.graph, use, goals, speed, facing, 0.0)
            self.walker.go_to(np.array([*points[:first], crossing.start]), speed)
            crossing = replace(crossing, beyond=max(way - self.walker.left, 0.0))
            self.events[-1] = SetOff(self.time, self.point, goals[-1], way)
        self.wanted, self.errand, self.row[at.BUSY] = "", None, 0.0
        self.crossing, self.row[at.CROSSES] = crossing, at.NOTHING if crossing is None else at.APPROACHES
        return routes

    def _go_on_to(self, points: NDArray[np.float64], speed: float, facing: float | None) -> list[Route]:
        """Go to others than it was told, behind the obstacle that it is about to clear."""
        people, of = self._people, self.crossing
        assert of is not None
        routes = people.crowd.find_routes(self.index, points, people.ranges, np.array(of.end))
        goals = tuple((float(x), float(y), float(z)) for x, y, z in points)
        way = sum(route.length for route in routes)
        self.crossing = replace(of, goals=goals, speed=speed, facing=facing, beyond=way)
        self.wanted, self.errand, self.row[at.BUSY] = "", None, 0.0
        return routes

    def _can_move_at(self, speed: float) -> bool:
        """Whether it can set out as it is: it stands, or crawls with free hands."""
        people, node = self._people, int(self.row[at.NODE])
        if self.playback is not None:
            return False
        if people.bases[node] == people.stand:
            return True
        return any(gait.posture == node and speed <= gait.fastest for gait in people.gaits)

    def stop(self) -> None:
        """Stop here."""
        self.errand = None
        if self.row[at.CROSSES] >= at.RUNS_UP:
            assert self.crossing is not None
            self.crossing = replace(self.crossing, goals=(), beyond=0.0)
            return
        self.crossing, self.row[at.CROSSES] = None, at.NOTHING
        if self.playback is None:
            self.walker.stop()

    def take(self, posture: str, held: str, state: str) -> None:
        """Take ``posture``, with an object in a state in its hands; one that moves comes to a stand first.
        To the graph's fatal posture it goes at once, but for one over an obstacle, who lands first. Raises
        `LocomotionError` for what the graph does not have, or has no way to; nothing has changed then."""
        self._orders.take(posture, held, state)

    # --- time
    def tick(self) -> None:
        """After its body has moved: go on with its postures."""
        self._orders.tick()

    @property
    def point(self) -> tuple[float, float, float]:
        """`position` as numbers."""
        x, y, z = self.position.tolist()
        return x, y, z

    def set_traits(self, traits: NDArray[np.float64]) -> None:
        """Move in another style: a row of `locomotion.body.traits.TRAITS` (7,)."""
        self.row[at.TRAITS] = traits

    def change(self, what: Callable[[], object]) -> None:
        """Do ``what`` changes where its pose comes from; the difference fades out."""
        old, old_rates = self.qpos, self.qpos_rates
        self.row[at.FADE_SECONDS] = 0.0
        what()
        self.fade(old, old_rates)

    def fade(self, old: NDArray[np.float64], old_rates: NDArray[np.float64]) -> None:
        """Let it look as if it came from pose ``old`` (46,), which changed by ``old_rates`` (45,)."""
        self.row[at.FADE_SECONDS] = 0.0
        now = self.qpos_at(0.0)
        self.begin_fade(fade_from(old, old_rates, now, rates(now, self.qpos_at(STEP), STEP)))

    def begin_fade(self, fade: Fade) -> None:
        """Let a difference fade out from now on."""
        row = self.row
        row[at.OFFSETS], row[at.RATES], row[at.FADE_SECONDS] = fade
        row[at.FADE_BEGUN] = self.time

    def go_on_from(
        self,
        pose: NDArray[np.float64],
        pose_rates: NDArray[np.float64],
        place: NDArray[np.float64],
        velocity: NDArray[np.float64],
    ) -> None:
        """Take over from a body in ``pose`` (46,), which changes by ``pose_rates`` (45,) as `fading.rates`,
        and moves at ``velocity`` (2,) [m/s] over ``place`` (3,): in its gait, at the phase most like it."""
        go_on_from(self, self._people, pose, pose_rates, place, velocity)

    # --- saving
    def save(self) -> PersonState:
        """Everything needed to continue from here."""
        return PersonState(
            self.walker.save(),
            self.row.copy(),
            self.playback,
            self.wanted,
            self.errand,
            self.crossing,
            self.turn,
        )

    def restore(self, state: PersonState) -> None:
        """Restore a state of this person."""
        self.walker.restore(state.body)
        self.row[:] = state.row
        self.playback, self.wanted, self.errand = state.playback, state.wanted, state.errand
        self.crossing, self._people.turns[self.walker.index] = state.crossing, state.turn

    def state_hash(self) -> str:
        """Hex digest of everything that decides its future."""
        return digest(self.save(), self.walker.state_hash())
