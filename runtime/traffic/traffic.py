"""Bodies that follow paths (dogs and people) give way to each other and to all others."""

from collections.abc import Callable, Sequence
from functools import partial

import numpy as np

from locomotion.avoidance.goal_occupancy import ROOM, is_before, who_stands_at
from locomotion.avoidance.options import cheapest, cost_of_meeting, options
from locomotion.avoidance.yielding import COUNT, SPACING, Course, first_meeting
from navmesh.routes.route_validity import line_holds
from runtime.bodies.protocol import Follower, Population
from runtime.planning.level import Level
from runtime.traffic.snapshot import Snapshot, foretold_on
from runtime.traffic.waiting_and_deadlock import STANDSTILL, untangle
from surefoot.pausing import pause

__all__ = ["EVERY", "Traffic"]

EVERY = 2
"""Ticks between choices."""
_TURNS = 10  # choices in which everybody has one turn, which spreads the work over ticks
_UNTIL_NEXT = 0.01 * EVERY * _TURNS  # [s]
_MORE = 0.2  # [m] before it must, at which a body prepares to stop beside others at its goal


class Traffic:
    """Lets the followers among ``populations`` give way, in order of creation. All memory between choices is
    in the bodies: their paths and paces."""

    def __init__(self, level: Level, populations: Sequence[Population]) -> None:
        self._level, self._populations = level, populations

    def direct(self, tick: int) -> None:
        """Let those whose turn it is choose; called before every `EVERY`th ``tick``."""
        slot = tick // EVERY % _TURNS
        turn = slot // 2 + _TURNS // 2 * (slot % 2)  # of few, two do not choose close to each other
        if turn >= sum(len(population.followers()) for population in self._populations):
            return
        snapshot = Snapshot(self._populations)
        turns = np.arange(turn, len(snapshot.followers), _TURNS)
        self._let_choose(snapshot, turns)
        for index in turns.tolist():
            if (snapshot.followers[index].waited or 0.0) >= STANDSTILL:
                untangle(snapshot, index, self._level.graph)

    def look_out(self, follower: Follower, former: Course | None) -> None:
        """Let a follower with a new goal choose; ``former``: the course it was on."""
        snapshot = Snapshot(self._populations)
        self._let_choose(snapshot, np.array([snapshot.followers.index(follower)]), former)

    def around(self, follower: Follower) -> tuple[np.ndarray, np.ndarray]:
        """Where the discs of those near a body will be (COUNT, k, 2), and their radii (k,) [m]."""
        snapshot = Snapshot(self._populations)
        near = snapshot.near(np.array([snapshot.followers.index(follower)]))[0]
        return snapshot.all_foretold(np.flatnonzero(near).tolist())

    def _let_choose(self, snapshot: Snapshot, turns: np.ndarray, former: Course | None = None) -> None:
        if len(turns) == 0 or len(snapshot) < 2:
            return
        for index, near in zip(turns.tolist(), snapshot.near(turns), strict=True):
            pause()
            follower = snapshot.followers[index]
            course = snapshot.course(index) if near.any() or follower.pace < 1.0 else None
            if course is None:
                continue
            group = snapshot.group(index)
            others = [
                each
                for each in np.flatnonzero(near & ~snapshot.are_of(group)).tolist()
                if not snapshot.gets_away(index, each)
            ]
            # a body that halts easily gives way to one that does not
            halts = partial(_any_rushes, snapshot, others)
            told = (*snapshot.all_foretold(others), ROOM)
            pace, shift = self._chosen(course, len(snapshot.discs[index]), told, halts, former)
            if shift is not None or pace != course.pace:
                follower.give_way(pace, shift)
                snapshot.forget(index)
            self._stop_at_the_group(follower, snapshot.course(index), group)

    def has_come(self, agent: Follower, goal: np.ndarray) -> bool:
        """Whether a body at rest belongs to the group around ``goal`` (3,)."""
        snapshot = Snapshot(self._populations)
        index = snapshot.followers.index(agent)
        own = snapshot.discs[index]
        group = who_stands_at(goal, float(own[0, 5]), snapshot.others(index))
        return is_before(own, agent.reach, group)

    def _stop_at_the_group(self, follower: Follower, course: Course | None, group: np.ndarray) -> None:
        """Let a body stop that will soon have to, before others at its goal."""
        if course is None or not len(group) or not course.aside:
            return
        ahead = max((len(course.points) - 1) * SPACING - course.length, 0.0)
        if not course.whole and ahead <= course.stops + course.speed * _UNTIL_NEXT + _MORE:
            follower.end_in(ahead)

    def _chosen(
        self,
        course: Course,
        discs: int,
        others: tuple[np.ndarray, np.ndarray, float],
        halts: Callable[[], bool],
        former: Course | None,
    ) -> tuple[float, np.ndarray | None]:
        """The pace and the shift of the cheapest option; ``others`` as of `cheapest`; ``halts``: whether
        somebody near does not halt easily, so that halting is an option."""
        met = first_meeting(foretold_on(course, course.points, 1.0, discs), course.radius, *others)
        if met[0] >= COUNT:
            return 1.0, None
        found, least = options(course, met[0], halts(), former), cost_of_meeting(*met)
        barred, meetings = np.zeros(len(found.shifts), np.bool_), np.full(len(found), np.nan)
        while True:
            best = cheapest(course, found, barred, others, discs, least, meetings)
            if best < 0:
                return 1.0, None
            shift = found.shift(best)
            if shift is None or self._is_free(course, shift):
                return float(found.paces[best]), shift
            barred[found.ways[best]] = True

    def _is_free(self, course: Course, shift: np.ndarray) -> bool:
        """Whether a course shifted to one side stays on the surface, away from its edges."""
        moved = np.flatnonzero(np.linalg.norm(shift, axis=1) > 0.02)
        points = course.points[moved].copy()
        points[:, :2] += shift[moved]
        return line_holds(self._level.graph, points, course.radius)


def _any_rushes(snapshot: Snapshot, bodies: Sequence[int]) -> bool:
    """Whether one of ``bodies`` does not halt easily."""
    courses = (snapshot.course(index) for index in bodies if index < len(snapshot.followers))
    return any(course is not None and course.slowest > 0.0 for course in courses)
