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

from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike, NDArray

import navmesh
from locomotion.crowd import Crowd, Walker
from locomotion.crowd import layout as body
from locomotion.data import POSTURES
from locomotion.gaits.limits import PERSON_RULES
from locomotion.postures.places import placed
from locomotion.postures.playback import pose_at
from locomotion.postures.posture_file import load_postures
from locomotion.postures.posture_graph import PostureGraph
from locomotion.postures.step_order import gaits_for
from locomotion.recorded.motion_set import MotionSet, load_motions
from locomotion.recorded.sampling import placed_roots, sample_gait, stride_of
from locomotion.recorded.skeletons import LEVELS, skeleton
from locomotion.recorded_people import layout as at
from locomotion.recorded_people.drawing import drawn
from locomotion.recorded_people.fading import STEP, fade_from, faded, rates
from locomotion.recorded_people.person import RecordedPerson

__all__ = ["BODY_TICKS", "RecordedPeople", "person_postures"]

BODY_TICKS = 3
"""Ticks for each of the bodies': between them figures are drawn on the straight line."""
_ACCELERATION = 3.0  # [m/s²] of their bodies
_SLUGGISH = 0.12  # [s] time constant of the speed at which they are drawn
_STANDS = "stand"


@lru_cache(maxsize=1)
def person_postures() -> PostureGraph:
    """The package's own posture graph."""
    return load_postures(POSTURES / "person.yaml")


class RecordedPeople:
    """``crowd``: their bodies. ``graph``: their postures; ``motions``: how they move, shared by all.
    ``rows``: (n, `layout.ROW`) what else is remembered; ``people``: one for each, in order."""

    def __init__(
        self,
        surface: navmesh.NodeGraph,
        graph: PostureGraph | None = None,
        motions: MotionSet | None = None,
        dt: float = 0.01,
    ) -> None:
        self.crowd, self.dt = Crowd(surface, BODY_TICKS * dt), dt
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
        self._rests = np.array(rests, np.int32)  # of each posture the gait that comes to rest in it
        self.stand = self.graph.postures.index(_STANDS)
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
        row = at.new_row(level, self.stand, float(chance.random()), np.array([*walker.position, walker.yaw]))
        row[at.SINCE] = self._since
        return self._take_in(walker, row)

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
        row, bodies = self._rows[index], self.crowd.rows
        bodies[index, [body.VX, body.VY]] = velocity
        row[at.PLACE] = *place, bodies[index, body.YAW]
        left = (BODY_TICKS - 1 - self._since) * self.dt
        behind = np.array([*((BODY_TICKS * self.dt - left) * velocity), 0.0, 0.0])
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
        rows, bodies, dt = self.rows, self.crowd.rows, self.dt
        rows[:, at.AGE] += 1.0
        since = (self._since + 1) % BODY_TICKS
        rows[:, at.SINCE] = since
        if since == 0:
            rows[:, at.BEFORE] = self._body_places()
            self.crowd.tick()
        share = (since + 1) / BODY_TICKS
        moved = self._body_places() - rows[:, at.BEFORE]
        moved[:, 3] = (moved[:, 3] + np.pi) % (2.0 * np.pi) - np.pi
        rows[:, at.PLACE] = rows[:, at.BEFORE] + share * moved
        pace = np.hypot(bodies[:, body.VX], bodies[:, body.VY])
        ahead = bodies[:, body.VX] * np.cos(bodies[:, body.YAW]) + bodies[:, body.VY] * np.sin(
            bodies[:, body.YAW]
        )
        moved = np.where(ahead < -0.5 * pace, -pace, pace)
        rows[:, at.SPEED] += (moved - rows[:, at.SPEED]) * min(dt / _SLUGGISH, 1.0)
        old = rows[:, at.GAIT].astype(np.int32)
        phase = rows[:, at.PHASE].copy()
        rows[:, at.PHASE] = (phase + dt * self._cadence(old, rows[:, at.SPEED])) % 1.0
        for index in np.flatnonzero(rows[:, at.BUSY]).tolist():
            self.people[index].tick()
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

    def _cadence(self, gaits: NDArray[np.int32], speeds: NDArray[np.float64]) -> NDArray[np.float64]:
        """Cycles a second."""
        pace = np.abs(speeds)
        strides = stride_of(self.motions, self._recorded[np.maximum(gaits, 0)], pace)
        return np.where(gaits >= 0, pace / strides, 0.0)

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
        special |= rows[:, at.BUSY] > 0.0
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
        gaits = rows[:, at.GAIT].astype(np.int32)
        speeds = np.where(gaits >= 0, np.abs(rows[:, at.SPEED]), 0.0)
        phases = rows[:, at.PHASE]
        if ahead != 0.0:
            phases = phases + ahead * self._cadence(gaits, rows[:, at.SPEED])
        played = np.where(gaits >= 0, gaits, self._rests[rows[:, at.NODE].astype(np.int32)])
        channels, roots = sample_gait(self.motions, level, self._recorded[played], speeds, phases)
        places = rows[:, at.PLACE]
        if ahead != 0.0:
            places[:, :2] += ahead * bodies[:, [body.VX, body.VY]]
        return channels, placed_roots(roots, places)

    def _adjusted(self, index: int, pose: NDArray[np.float64], ahead: float) -> NDArray[np.float64]:
        """The pose (46,) of a figure: as its gait or postures have it, its hands, and a change of late."""
        person, row = self.people[index], self.rows[index]
        now = person.time + ahead
        if person.playback is not None:
            pose = pose_at(self.graph, person.playback, max(now, person.playback.begun))
            x, y, z, yaw = row[at.PLACE]
            pose = placed(pose, np.array([x, y, yaw]))
            pose[2] += z
        elif int(row[at.NODE]) != self.stand:
            pose = pose.copy()
            self._hold(pose, int(row[at.NODE]))
        return faded(
            pose,
            row[at.OFFSETS],
            row[at.RATES],
            float(row[at.FADE_SECONDS]),
            max(now - float(row[at.FADE_BEGUN]), 0.0),
        )

    def _hold(self, pose: NDArray[np.float64], node: int) -> None:
        """Let the hands of ``pose`` (46,) do what they do in a node."""
        free, held = self.graph.poses[self.bases[node]], self.graph.poses[node]
        differs = np.flatnonzero(np.abs(held[7:] - free[7:]) > 1e-9) + 7
        pose[differs] = held[differs]
