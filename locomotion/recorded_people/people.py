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
from locomotion.crowd import Crowd, Walker
from locomotion.crowd import layout as body
from locomotion.data import POSTURES
from locomotion.gaits.limits import PERSON_RULES
from locomotion.ground.ground import Ground
from locomotion.postures.places import placed
from locomotion.postures.playback import pose_at
from locomotion.postures.posture_file import load_postures
from locomotion.postures.posture_graph import PostureGraph
from locomotion.postures.step_order import gaits_for
from locomotion.recorded.foot_planting import planted
from locomotion.recorded.footfalls import BEARS, FEET, footing, footing_at, sole_centres
from locomotion.recorded.individual import PACE, SIZE, by_chance, styled
from locomotion.recorded.motion_set import MotionSet, load_motions
from locomotion.recorded.posing import posed
from locomotion.recorded.sampling import sample_gait
from locomotion.recorded.skeletons import LEVELS, skeleton
from locomotion.recorded_people import layout as at
from locomotion.recorded_people.clearing import out_of_the_floor, recorded_skills, skill_ranges
from locomotion.recorded_people.drawing import drawn
from locomotion.recorded_people.fading import STEP, fade_from, faded, rates
from locomotion.recorded_people.person import RecordedPerson
from locomotion.recorded_people.stepping import AIM, LAST, advance_figures, cadences, lay_feet

__all__ = ["BODY_TICKS", "RecordedPeople", "person_postures"]

BODY_TICKS = 3
"""Ticks for each of the bodies': between them figures are drawn on the straight line."""
_ACCELERATION = 2.0  # [m/s²] of their bodies
_STRIKES = np.array([0.0, 0.5])  # phases at which the right and the left foot strike
_BEFORE_STRIKE = 1.0 - 1e-6
_STANDS = "stand"


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
        self._recorded = np.array([self.motions.gait(gait.name) for gait in self.gaits], np.int64)
        names = self.graph.postures
        self.bases = np.array([names.index(name.partition("/")[0]) for name in names], np.int32)
        """(p,) of each posture the one with free hands."""
        rests = [
            next((k for k, gait in enumerate(self.gaits) if gait.posture == base), 0) for base in self.bases
        ]
        self._rests = self._recorded[rests]  # of each posture the gait that comes to rest in it
        m = self.motions
        self._motion = m.gait_first, m.cycles, m.speeds, m.seconds, m.rests, footing(m)
        self.stand = self.graph.postures.index(_STANDS)
        self.skills = recorded_skills(self.motions)
        """What it takes to clear obstacles, by affordance."""
        self.ranges = skill_ranges(self.motions)
        """Least and greatest size [m] of these."""
        self.people: list[RecordedPerson] = []
        self._rows = np.zeros((64, at.ROW))

    def __len__(self) -> int:
        return len(self.people)

    @property
    def rows(self) -> NDArray[np.float64]:
        """A view."""
        return self._rows[: len(self.people)]

    def add(self, position: ArrayLike, yaw: float, level: int, chance: np.random.Generator) -> RecordedPerson:
        """One that stands at ``position`` (3,) [m], facing ``yaw`` [rad]; ``chance`` makes it differ from the
        others. Raises `LocomotionError` where there is no room."""
        walker = self.crowd.add(position, PERSON_RULES["radius"], yaw, _ACCELERATION)
        traits = by_chance(int(chance.integers(2**31)))
        traits[SIZE] = 1.0  # all have the build of those that are simulated
        row = at.new_row(level, self.stand, traits, np.array([*walker.position, walker.yaw]))
        row[at.SINCE] = self._since
        person = self._take_in(walker, row)
        self.lay_feet(person.index)
        return person

    @property
    def _place(self) -> tuple:
        """What kernels know of the level: net, its origin, lookup of the ground."""
        return self.crowd.net, self.crowd.origin, self._ground.lookup

    def lay_feet(self, index: int) -> None:
        """Let a figure have its feet on the ground from now on, as its gait or its stand has them."""
        lay_feet(
            self._place, self._motion, self._recorded, self._rests, self._rows[index], self.crowd.rows[index]
        )

    def cadence(self, index: int) -> float:
        """Cycles a second of a figure."""
        out = np.empty(1)
        part = slice(index, index + 1)
        cadences(self._motion, self._recorded, self.rows[part], self.crowd.rows[part], out)
        return float(out[0])

    def lay_feet_of(self, index: int, pose: NDArray[np.float64]) -> None:
        """As `lay_feet`, but a foot that bears stands where ``pose`` (46,) has it."""
        self.lay_feet(index)
        row = self._rows[index]
        full, steps = skeleton("full"), row[at.STEPS].reshape(2, 3, 6)
        bodies = posed(full, pose[None, 7 + full.joints], pose[None, :7])
        footing = footing_at(self.motions, int(self._played(row[None])[0]), [abs(row[at.SPEED])])[0]
        for side, name in enumerate(FEET):
            if (row[at.PHASE] - _STRIKES[side]) % 1.0 >= footing[side, BEARS] and row[at.GAIT] >= 0.0:
                continue
            centres, turned = sole_centres(bodies[:, full.bodies.index(name)])
            last = steps[side, LAST]
            last[:2], last[3] = centres[0, :2], steps[side, AIM, 3] + _turn(turned[0] - steps[side, AIM, 3])
            height = float(self._ground.surface_below([centres[0] + [0.0, 0.0, 0.3]])[0][0])
            if abs(height - last[2]) < 0.3:
                last[2] = height

    def _played(self, rows: NDArray[np.float64]) -> NDArray[np.int64]:
        """(n,) numbers of the gaits, in the motions, that are sampled of figures."""
        gaits, nodes = rows[:, at.GAIT].astype(np.int64), rows[:, at.NODE].astype(np.int64)
        return np.where(gaits >= 0, self._recorded[gaits], self._rests[nodes])

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
    def _since(self) -> int:
        """Ticks since the bodies' last."""
        return int(self._rows[0, at.SINCE]) if self.people else 0

    @property
    def bodies_move(self) -> bool:
        """Whether the next tick is one of the bodies, too."""
        return self._since == BODY_TICKS - 1

    def begin_at(self, index: int, place: NDArray[np.float64], velocity: NDArray[np.float64]) -> None:
        """Let a figure be drawn at ``place`` (3,) now, and go on from there at ``velocity`` (2,) [m/s] until
        its body's next tick."""
        row, walker = self._rows[index], self.crowd.rows[index]
        walker[[body.VX, body.VY]] = velocity
        row[at.PLACE] = *place, walker[body.YAW]
        left = (BODY_TICKS - 1 - self._since) * self.dt
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
        self._rows[len(self.people)] = row
        self.people.append(RecordedPerson(self, walker))
        return self.people[-1]

    def remove(self, person: RecordedPerson) -> None:
        """Have one less; the indices of those after it decrease by one."""
        index = person.index
        self._rows[index:-1] = self._rows[index + 1 :]
        del self.people[index]
        self.crowd.remove(index)

    def tick(self) -> None:
        """Advance all by ``dt``."""
        if not self.people:
            return
        rows, dt = self.rows, self.dt
        since = (self._since + 1) % BODY_TICKS
        rows[:, at.SINCE] = since
        if since == 0:
            rows[:, at.BEFORE] = self._body_places()
            self.crowd.tick()
            for index in np.flatnonzero(rows[:, at.CROSSES] == at.APPROACHES).tolist():
                self.people[index].course.stay()
            for index in np.flatnonzero(rows[:, at.CROSSES] >= at.RUNS_UP).tolist():
                self.people[index].course.move_on(BODY_TICKS * dt)
        old, phase = rows[:, at.GAIT].astype(np.int32), rows[:, at.PHASE].copy()
        tick = (dt, (since + 1) * dt, (since + 1) / BODY_TICKS)
        advance_figures(self._place, self._motion, self._recorded, self._rests, rows, self.crowd.rows, tick)
        for index in np.flatnonzero(rows[:, at.BUSY]).tolist():
            self.people[index].tick()
        if since == BODY_TICKS - 1:
            for index in np.flatnonzero(rows[:, at.CROSSES]).tolist():
                self.people[index].course.cross()
        self._choose_gaits(old, phase)

    def _body_places(self) -> NDArray[np.float64]:
        """(n, 4) x, y, z [m] and yaw [rad] of the bodies."""
        return np.column_stack([self.crowd.positions, self.crowd.yaws])

    def _choose_gaits(self, old: NDArray[np.int32], phase: NDArray[np.float64]) -> None:
        """At the end of a step, and at rest, each may change its gait."""
        rows = self.rows
        chosen = gaits_for(self.gaits, old, self.bases[rows[:, at.NODE].astype(np.int32)], rows[:, at.SPEED])
        chosen[rows[:, at.BUSY] > 0.0] = -1
        steps = (2.0 * rows[:, at.PHASE]).astype(np.int32) != (2.0 * phase).astype(np.int32)
        chosen[rows[:, at.CROSSES] == at.CLEARS] = -1
        may = (chosen != old) & (steps | (old < 0) | (chosen < 0))
        of = np.flatnonzero(may)
        if len(of) == 0:
            return
        drawn_now, before = self.qpos(of), self.qpos(of, -STEP)
        rows[of, at.GAIT], rows[of, at.FADE_SECONDS] = chosen[of], 0.0
        new, after = self.qpos(of), self.qpos(of, STEP)
        for k, index in enumerate(of.tolist()):
            old_rates, new_rates = rates(before[k], drawn_now[k], STEP), rates(new[k], after[k], STEP)
            self.people[index].begin_fade(fade_from(drawn_now[k], old_rates, new[k], new_rates))

    # --- poses
    def qpos(self, indices: NDArray[np.int64], ahead: float = 0.0) -> NDArray[np.float64]:
        """(n, 46) the poses of some, ``ahead`` [s] of now if all goes on as it does: ``qpos`` of the person
        at full detail; what a figure's level has no channel for is 0."""
        out = np.empty((len(indices), 46))
        levels = self.rows[indices, at.LEVEL].astype(np.int64)
        for number, name in enumerate(LEVELS):
            of = np.flatnonzero(levels == number)
            if len(of):
                out[of] = skeleton(name).as_qpos(*self._sampled(indices[of], number, ahead))
        for k, index in enumerate(indices.tolist()):
            out[k] = self._adjusted(index, out[k], ahead)
        return out

    def transforms(self, indices: NDArray[np.int64], ahead: float = 0.0) -> NDArray[np.float64]:
        """(n, 20, 7) places [m] and quaternions (w, x, y, z) of the bodies of some figures, in the order of
        the person's model, ``ahead`` [s] of now."""
        out = np.empty((len(indices), 20, 7))
        rows, levels = self.rows[indices], self.rows[indices, at.LEVEL].astype(np.int64)
        ages = rows[:, at.AGE] * self.dt
        special = (ages < rows[:, at.FADE_BEGUN] + rows[:, at.FADE_SECONDS]) | (
            rows[:, at.NODE] != self.stand
        )
        special |= (rows[:, at.BUSY] > 0.0) | (rows[:, at.CROSSES] == at.CLEARS)
        for number, name in enumerate(LEVELS):
            of = np.flatnonzero((levels == number) & ~special)
            if len(of):
                out[of] = drawn(name, *self._sampled(indices[of], number, ahead))
        of = np.flatnonzero(special)
        if len(of):
            qpos, bones = self.qpos(indices[of], ahead), skeleton(LEVELS[0])
            out[of] = drawn(LEVELS[0], qpos[:, 7 + bones.joints], qpos[:, :7])
        return out

    def _sampled(
        self, indices: NDArray[np.int64], level: int, ahead: float
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Channels and roots of some figures of one level, by gait, without what is special to them."""
        rows, bodies = self.rows[indices], self.crowd.rows[indices]
        moves, played = rows[:, at.GAIT] >= 0.0, self._played(rows)
        traits = rows[:, at.TRAITS]
        speeds = np.where(moves, np.abs(rows[:, at.SPEED]), 0.0) * traits[:, PACE]
        gone = np.zeros(len(rows))
        if ahead != 0.0:
            cadences(self._motion, self._recorded, rows, bodies, gone)
            gone *= ahead
        places, phases = rows[:, at.PLACE], rows[:, at.PHASE] + gone
        if ahead != 0.0:
            places[:, :2] += ahead * bodies[:, [body.VX, body.VY]]
        sample = sample_gait(self.motions, level, played, speeds, phases)
        sample = styled(skeleton(LEVELS[level]), sample, traits)
        # a foot stays in the part of its cycle that it is in: where it stands is known for that
        since = (rows[:, at.PHASE, None] - _STRIKES) % 1.0 + gone[:, None]
        since = np.where(moves[:, None], since.clip(0.0, _BEFORE_STRIKE), 0.0)
        since[rows[:, at.LAID] == 0.0] = -1.0
        footfalls = rows[:, at.STEPS].reshape(-1, 2, 3, 6)[:, :, :AIM]
        return planted(self.motions, level, (played, speeds, phases), sample, places, footfalls, since)

    def _adjusted(self, index: int, pose: NDArray[np.float64], ahead: float) -> NDArray[np.float64]:
        """The pose (46,) of a figure: as its gait or postures have it, its hands, and a change of late."""
        person, row = self.people[index], self.rows[index]
        now = person.time + ahead
        if row[at.CROSSES] == at.CLEARS:
            pose = person.course.pose(now)
        elif person.playback is not None:
            pose = pose_at(self.graph, person.playback, max(now, person.playback.begun))
            x, y, z, yaw = row[at.PLACE]
            pose = placed(pose, np.array([x, y, yaw]))
            pose[2] += z
        if person.playback is None and int(row[at.NODE]) != self.stand:
            pose = pose.copy()
            self._hold(pose, int(row[at.NODE]))
        elapsed = max(now - float(row[at.FADE_BEGUN]), 0.0)
        pose = faded(pose, row[at.OFFSETS], row[at.RATES], float(row[at.FADE_SECONDS]), elapsed)
        floor = person.course.floor(now)
        return pose if floor is None else out_of_the_floor(pose, *floor)

    def _hold(self, pose: NDArray[np.float64], node: int) -> None:
        """Let the hands of ``pose`` (46,) do what they do in a node."""
        free, held = self.graph.poses[self.bases[node]], self.graph.poses[node]
        differs = np.flatnonzero(np.abs(held[7:] - free[7:]) > 1e-9) + 7
        pose[differs] = held[differs]
