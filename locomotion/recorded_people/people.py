"""Many recorded persons on one surface: bodies of a crowd, drawn by recorded motion.

    people = RecordedPeople(graph)
    ada = people.add((2.0, 3.0, 0.0), 0.0, LOW, np.random.default_rng(1))
    ada.go_to([(9.0, 3.0, 0.0)], speed=1.4)
    people.tick()
    places = people.transforms(np.array([ada.index]))       # (1, 20, 7)

A body moves as a walker does; which step follows, and how far through it a figure is, goes by the way it has
covered. A pose is a function of that state: it is computed when somebody asks for it, for one or for many.
"""

from __future__ import annotations

from functools import lru_cache, partial

import numpy as np
from numpy.typing import ArrayLike, NDArray

import navmesh
from locomotion.body.traits import SIZE, by_chance
from locomotion.crowd import Crowd, Walker
from locomotion.crowd import layout as body
from locomotion.data import POSTURES
from locomotion.gaits.limits import PERSON_RULES
from locomotion.ground.ground import Ground
from locomotion.postures.places import placed
from locomotion.postures.playback import pose_at
from locomotion.postures.posture_file import load_postures
from locomotion.postures.posture_graph import PostureGraph
from locomotion.recorded.footfalls import BEARS, FEET, footing_at, sole_centres
from locomotion.recorded.motion_set import MotionSet, load_motions
from locomotion.recorded.posing import posed
from locomotion.recorded.skeletons import LEVELS, skeleton
from locomotion.recorded_people import layout as at
from locomotion.recorded_people.between_ticks import come_due, take_turns, write_discs
from locomotion.recorded_people.clearing import out_of_the_floor
from locomotion.recorded_people.drawing import drawn
from locomotion.recorded_people.fading import faded
from locomotion.recorded_people.figure_tables import figure_tables
from locomotion.recorded_people.person import RecordedPerson
from locomotion.recorded_people.posing_figures import choose_gaits, draw_figures, pose_figures
from locomotion.recorded_people.recorded_skills import recorded_skills, skill_ranges
from locomotion.recorded_people.stepping import (
    AIM,
    LAST,
    advance_figures,
    cadence_of,
    gait_played,
    lay_feet,
    since_strike,
)

__all__ = ["BODY_TICKS", "RecordedPeople", "person_postures"]

BODY_TICKS = 3
"""Ticks for each of the bodies': between them figures are drawn on the straight line."""
_ACCELERATION = 2.0  # [m/s²] of their bodies
_STANDS = "stand"
_RATES = np.array([float(skeleton(name).rate) for name in LEVELS])  # [Hz] at which levels are drawn
_TURN = 0.5 * (np.sqrt(5.0) - 1.0)  # the golden ratio: any number of figures have their turns evenly
_ASIDE = 0.02  # [m] of where its gait has it, within which a foot is left standing where it does


@lru_cache(maxsize=1)
def person_postures() -> PostureGraph:
    """The package's own posture graph."""
    return load_postures(POSTURES / "person.yaml")


def _turn(angle: float) -> float:
    """The same angle, -π to π."""
    return (angle + np.pi) % (2.0 * np.pi) - np.pi


def _ground_of(surface: navmesh.NodeGraph) -> Ground:
    return Ground.from_arrays(surface.terrain.vertices, surface.terrain.faces)


class RecordedPeople:
    """``crowd``: their bodies. ``graph``: their postures; ``motions``: how they move, shared by all.
    ``rows``: (n, `layout.ROW`) what else is remembered; ``people``: one for each, in order."""

    def __init__(
        self,
        surface: navmesh.NodeGraph,
        graph: PostureGraph | None = None,
        motions: MotionSet | None = None,
        dt: float = 0.01,
        ground: Ground | None = None,
    ) -> None:
        self.crowd, self.dt = Crowd(surface, BODY_TICKS * dt), dt
        self._ground = ground or _ground_of(surface)
        self.graph = graph or person_postures()
        self.motions = motions or load_motions()
        self.gaits = tuple(gait for gait in self.graph.gaits if gait.name in self.motions.gaits)
        """Those that there is motion for."""
        self._figures = figure_tables(self.motions, self.graph, self.gaits)
        self.bases = self._figures.bases
        """(p,) of each posture the one with free hands."""
        self.stand = self.graph.postures.index(_STANDS)
        self.skills = recorded_skills(self.motions)
        """What it takes to clear obstacles, by affordance."""
        self.ranges = skill_ranges(self.motions)
        """Least and greatest size [m] of these."""
        self.people: list[RecordedPerson] = []
        self._arrivals = 0  # so far
        self._rows = np.zeros((64, at.ROW))
        self.turns = np.zeros(64)
        """Of each figure `RecordedPerson.turn`."""

    def __len__(self) -> int:
        return len(self.people)

    @property
    def rows(self) -> NDArray[np.float64]:
        """A view."""
        return self._rows[: len(self.people)]

    def row(self, index: int) -> NDArray[np.float64]:
        """(`layout.ROW`,) what is remembered of one; a view."""
        return self._rows[index]

    def add(self, position: ArrayLike, yaw: float, level: int, chance: np.random.Generator) -> RecordedPerson:
        """One that stands at ``position`` (3,) [m], facing ``yaw`` [rad]; ``chance`` makes it differ from the
        others. Raises `LocomotionError` where there is no room."""
        walker = self.crowd.add(position, PERSON_RULES["radius"], yaw, _ACCELERATION)
        traits = by_chance(int(chance.integers(2**31)))
        traits[SIZE] = 1.0  # that of those who are simulated, into whom it may change
        row = at.new_row(level, self.stand, traits, np.array([*walker.position, walker.yaw]))
        row[at.SINCE] = self._least_taken_turn
        person = self._take_in(walker, row)
        self.lay_feet(person.index)
        return person

    @property
    def _level(self) -> tuple:
        """What kernels know of figures and the level: its net, its origin, lookup of the ground."""
        return self._figures, self.crowd.net, self.crowd.origin, self._ground.lookup

    def lay_feet(self, index: int) -> None:
        """Let a figure have its feet on the ground from now on, as its gait or its stand has them."""
        lay_feet(*self._level, self._rows[index], self.crowd.rows[index])

    def cadence(self, index: int) -> float:
        """Cycles a second of a figure."""
        return float(cadence_of(self._figures, self._rows[index], self.crowd.rows[index]))

    def lay_feet_of(self, index: int, pose: NDArray[np.float64]) -> None:
        """As `lay_feet`, but a foot that bears stands where ``pose`` (46,) has it, or nearly: one that is far
        from where the gait has it would drag the pelvis down and kick."""
        self.lay_feet(index)
        row = self._rows[index]
        full, steps = skeleton("full"), row[at.STEPS].reshape(2, 3, 6)
        bodies = posed(full, pose[None, 7 + full.joints], pose[None, :7])
        bodies[:, :, :3] = pose[:3] + row[at.TRAITS][SIZE] * (bodies[:, :, :3] - pose[:3])
        footing = footing_at(self.motions, int(gait_played(self._figures, row)), [abs(row[at.SPEED])])[0]
        for side, name in enumerate(FEET):
            if since_strike(row[at.PHASE], side) >= footing[side, BEARS] and row[at.GAIT] >= 0.0:
                continue
            centres, turned = sole_centres(bodies[:, full.bodies.index(name)])
            last = steps[side, LAST]
            off = centres[0, :2] - last[:2]
            last[:2] += off * min(1.0, _ASIDE / max(float(np.hypot(*off)), _ASIDE))
            last[3] = steps[side, AIM, 3] + _turn(turned[0] - steps[side, AIM, 3])
            height = float(self._ground.surface_below([centres[0] + [0.0, 0.0, 0.3]])[0][0])
            if abs(height - last[2]) < 0.3:
                last[2] = height

    def change_level(self, surface: navmesh.NodeGraph, ground: Ground | None = None) -> None:
        """Go on on another surface, as `Crowd.change_graph`."""
        self.crowd.change_graph(surface)
        self._ground = ground or _ground_of(surface)
        for index in np.flatnonzero(self.rows[:, at.CROSSES] == at.RUNS_UP).tolist():
            course = self.people[index].course
            if not course.of.is_there(surface):
                course.give_up()
        for index in np.flatnonzero((self.rows[:, at.LAID] > 0.0) & (self.rows[:, at.STILL] > 0.0)).tolist():
            self.people[index].change(partial(self.lay_feet, index))

    @property
    def _least_taken_turn(self) -> int:
        """The turn that the fewest bodies have, as ticks since their last."""
        return int(np.argmin(np.bincount(self.rows[:, at.SINCE].astype(np.int64), minlength=BODY_TICKS)))

    def begin_at(self, index: int, place: NDArray[np.float64], velocity: NDArray[np.float64]) -> None:
        """Let a figure be drawn at ``place`` (3,) now, and go on from there at ``velocity`` (2,) [m/s] until
        its body's next tick."""
        row, walker = self._rows[index], self.crowd.rows[index]
        walker[[body.VX, body.VY]] = velocity
        row[at.PLACE] = *place, walker[body.YAW]
        left = (BODY_TICKS - 1 - row[at.SINCE]) * self.dt
        ahead = np.array([*(left * velocity), 0.0])
        self.crowd.shift(index, ahead)
        gone = BODY_TICKS * self.dt - left
        behind = np.array([*(gone * velocity), 0.0, 0.0])
        row[at.BEFORE] = row[at.PLACE] - behind

    def adopt(self, walker: Walker, row: NDArray[np.float64]) -> RecordedPerson:
        """One whose body is ``walker``, the last of the crowd, and whose row is ``row``."""
        return self._take_in(walker, row)

    def _take_in(self, walker: Walker, row: NDArray[np.float64]) -> RecordedPerson:
        if len(self.people) == len(self._rows):
            self._rows = np.concatenate([self._rows, np.zeros_like(self._rows)])
            self.turns = np.concatenate([self.turns, np.zeros_like(self.turns)])
        self._rows[len(self.people)] = row
        self.turns[len(self.people)] = self._arrivals * _TURN % 1.0
        self.people.append(RecordedPerson(self, walker))
        self._arrivals += 1
        return self.people[-1]

    def remove(self, person: RecordedPerson) -> None:
        """Have one less; the indices of those after it decrease by one."""
        index = person.index
        self._rows[index:-1] = self._rows[index + 1 :]
        self.turns[index:-1] = self.turns[index + 1 :]
        del self.people[index]
        self.crowd.remove(index)

    def discs(self) -> NDArray[np.float64]:
        """(n, 6) discs that cover all figures where they are drawn, as of `Crowd.lead`."""
        out = np.empty((len(self.people), 6))
        write_discs(self._rows, self.crowd.rows, out)
        return out

    def tick(self) -> None:
        """Advance all by ``dt``."""
        if not self.people:
            return
        rows, dt, count = self.rows, self.dt, len(self.people)
        turns, apart, phases = np.empty(count, np.bool_), np.empty(count, np.bool_), np.empty(count)
        take_turns(rows, self.crowd.rows, self.crowd.origin, BODY_TICKS, turns, apart)
        self.crowd.tick(turns)
        special = np.flatnonzero(apart).tolist()
        for index in special:
            if turns[index] and rows[index, at.CROSSES] == at.APPROACHES:
                self.people[index].course.stay()
            elif turns[index] and rows[index, at.CROSSES] >= at.RUNS_UP:
                self.people[index].course.move_on(BODY_TICKS * dt)
        advance_figures(*self._level, rows, self.crowd.rows, (dt, BODY_TICKS), phases)
        for index in special:
            if rows[index, at.BUSY]:
                self.people[index].tick()
        for index in special:
            if rows[index, at.CROSSES] and rows[index, at.SINCE] == BODY_TICKS - 1.0:
                self.people[index].course.cross()
        choose_gaits(self._figures, rows, self.crowd.rows, phases, dt)

    # --- poses
    def qpos(self, indices: NDArray[np.int64], ahead: float = 0.0) -> NDArray[np.float64]:
        """(n, 46) the poses of some, ``ahead`` [s] of now if all goes on as it does: ``qpos`` of the person
        at full detail; what a figure's level has no channel for is 0."""
        out, apart = np.empty((len(indices), 46)), np.empty(len(indices), np.bool_)
        pose_figures(self._figures, indices, self._rows, self.crowd.rows, (ahead, self.dt), out, apart)
        for k in self._apart(indices, apart):
            out[k] = self._adjusted(int(indices[k]), ahead)
        return out

    def transforms(self, indices: NDArray[np.int64], ahead: float = 0.0) -> NDArray[np.float64]:
        """(n, 20, 7) places [m] and quaternions (w, x, y, z) of the bodies of some figures, in the order of
        the person's model, ``ahead`` [s] of now."""
        out, apart = np.empty((len(indices), 20, 7)), np.empty(len(indices), np.bool_)
        these = np.ascontiguousarray(indices)
        draw_figures(self._figures, these, self._rows, self.crowd.rows, (ahead, self.dt), out, apart)
        of = self._apart(indices, apart)
        if of:
            qpos, bones = self.qpos(indices[of], ahead), skeleton(LEVELS[0])
            figures = drawn(LEVELS[0], qpos[:, 7 + bones.joints], qpos[:, :7])
            sizes = self._rows[indices[of], at.TRAITS.start + SIZE, None, None]
            figures[:, :, :3] = qpos[:, None, :3] + sizes * (figures[:, :, :3] - qpos[:, None, :3])
            out[of] = figures
        return out

    def due(self, indices: NDArray[np.int64], since: ArrayLike, now: float) -> NDArray[np.bool_]:
        """(n,) which of some figures have had a moment to be drawn at after the time ``since`` [s] (one or
        (n,)), until ``now``: those in full detail always, the others as often as their motion is kept, in
        turn. After a time long past or -inf all have."""
        after, due = np.empty(len(indices)), np.empty(len(indices), np.bool_)
        after[:] = since
        come_due(_RATES, self._rows, self.turns, np.ascontiguousarray(indices), after, now, due)
        return due

    def _apart(self, indices: NDArray[np.int64], may_be: NDArray[np.bool_]) -> list[int]:
        """Which of ``indices``, of those that ``may_be`` (n,), play their postures or clear an obstacle."""
        return [
            k
            for k in np.flatnonzero(may_be).tolist()
            if self._rows[indices[k], at.CROSSES] == at.CLEARS or self.people[indices[k]].playback is not None
        ]

    def _adjusted(self, index: int, ahead: float) -> NDArray[np.float64]:
        """The pose (46,) of a figure that clears an obstacle or plays its postures, with a change of late."""
        person, row = self.people[index], self.rows[index]
        now, size = person.time + ahead, float(row[at.TRAITS][SIZE])
        if row[at.CROSSES] == at.CLEARS:
            pose = person.course.pose(now)
            if int(row[at.NODE]) != self.stand:
                held = self._figures.held[int(row[at.NODE])]
                pose[7:] = np.where(np.isnan(held), pose[7:], held)
        else:
            assert person.playback is not None
            pose = pose_at(self.graph, person.playback, max(now, person.playback.begun))
            pose[:3] *= size
            x, y, z, yaw = row[at.PLACE]
            pose = placed(pose, np.array([x, y, yaw]))
            pose[2] += z
        elapsed = max(now - float(row[at.FADE_BEGUN]), 0.0)
        pose = faded(pose, row[at.OFFSETS], row[at.RATES], float(row[at.FADE_SECONDS]), elapsed)
        if row[at.CROSSES] == at.CLEARS and int(row[at.NODE]) == self.stand:
            pose = person.course.on_its_hands(pose, now)
        floor = person.course.floor(now)
        return pose if floor is None else out_of_the_floor(pose, *floor, size)
