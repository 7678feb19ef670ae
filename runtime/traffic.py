"""Bodies that follow paths, dogs and people, give way to each other and to everybody else."""

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from locomotion.gathering import ROOM, STOREY, free_points, is_before, who_stands_at
from locomotion.giving_way import (
    COUNT,
    SPACING,
    STEP,
    Course,
    Options,
    cost_of_meeting,
    first_meeting,
    foretell,
    meetings,
    options,
)
from navmesh.holding import line_holds
from runtime.drivers import Follower, Population
from runtime.level import Level

__all__ = ["EVERY", "Traffic"]

EVERY = 4
"""Ticks between choices."""
_TURNS = 5  # choices in which everybody has its turn once, so that no tick has to bear all of them
_SLACK = 3.5  # [m] between two that go straight on, from which what they do is looked at closely
_UNTIL_NEXT = 0.01 * EVERY * _TURNS  # [s]
_MORE = 0.2  # [m] before it has to, from which a body prepares to stop beside those at its goal


class Traffic:
    """Lets the followers among ``populations`` give way, one after the other in order of their making.

    All that is remembered between choices is kept in the bodies: their paths and paces.
    """

    def __init__(self, level: Level, populations: Sequence[Population]) -> None:
        self._level, self._populations = level, populations

    def direct(self, tick: int) -> None:
        """Let those choose whose turn it is; called before every `EVERY`th ``tick``."""
        self._let_choose(lambda followers: np.arange(len(followers)) % _TURNS == tick // EVERY % _TURNS)

    def look_out(self, follower: Follower) -> None:
        """Let one choose that has just been told where to go."""
        self._let_choose(lambda followers: np.array([each is follower for each in followers]))

    def _let_choose(self, turns: Callable[[list[Follower]], np.ndarray]) -> None:
        followers, rows, discs = self._gather()
        if not followers or len(rows) < 2:
            return
        near = meetings(
            rows[:, :2].copy(),
            rows[:, 3:5].copy(),
            rows[:, 2].copy(),
            np.arange(len(followers)),
            _SLACK,
            STOREY,
        )
        wanted = near.any(axis=1)
        wanted |= np.array([each.pace < 1.0 for each in followers])
        wanted &= turns(followers)
        told: dict[int, np.ndarray] = {}
        courses: dict[int, Course | None] = {}
        groups: dict[int, np.ndarray] = {}

        def course_of(index: int) -> Course | None:
            if index not in courses:
                course, groups[index] = followers[index].course(), rows[:0]
                if course is not None and course.whole:
                    others = np.concatenate([each for j, each in enumerate(discs) if j != index])
                    course, groups[index] = _up_to_the_group(course, others)
                courses[index] = course
            return courses[index]

        def foretold(index: int) -> np.ndarray:
            """(COUNT, d, 2) where a body will be."""
            if index not in told:
                course = course_of(index) if index < len(followers) else None
                if course is None:
                    told[index] = _straight_on(discs[index])
                else:
                    # its nose is its own concern: it is not to keep back whoever it has come behind
                    body = replace(course, length=course.length - followers[index].reach)
                    told[index] = _places(body, course.points, course.pace, len(discs[index]))
            return told[index]

        for index in np.flatnonzero(wanted).tolist():
            course = course_of(index)
            if course is None:
                continue
            near_by, group = np.flatnonzero(near[index]).tolist(), groups[index][:, :2]
            others = [j for j in near_by if not (discs[j][:, None, :2] == group).all(axis=2).any()]
            # who halts at once gives way to who does not
            halts = any(other < len(followers) and _rushes(course_of(other)) for other in others)
            if others:
                there = np.concatenate([foretold(other) for other in others], axis=1)
                radii = np.concatenate([discs[other][:, 5] for other in others])
            else:
                there, radii = np.empty((COUNT, 0, 2)), np.empty(0)
            chosen = self._chosen(course, len(discs[index]), there, radii, halts)
            if chosen.shift is not None or chosen.pace != course.pace:
                followers[index].give_way(chosen.pace, chosen.shift)
                courses.pop(index, None)
                told.pop(index, None)
            self._stop_at_the_group(followers[index], course_of(index), groups[index])

    def has_come(self, agent: Follower, goal: np.ndarray) -> bool:
        """Whether one at rest stands in the group of those at rest around ``goal`` (3,)."""
        followers, _, discs = self._gather()
        index = followers.index(agent)
        own = discs.pop(index)
        if not discs:
            return False
        group = who_stands_at(goal, float(own[0, 5]), np.concatenate(discs))
        return is_before(own, agent.reach, group)

    def _stop_at_the_group(self, follower: Follower, course: Course | None, group: np.ndarray) -> None:
        """Let a body that has to stop soon, before those who stand at its goal, do that."""
        if course is None or not len(group) or not course.aside:
            return
        ahead = max((len(course.points) - 1) * SPACING - course.length, 0.0)
        if not course.whole and ahead <= course.stops + course.speed * _UNTIL_NEXT + _MORE:
            follower.end_in(ahead)

    def _gather(self) -> tuple[list[Follower], np.ndarray, list[np.ndarray]]:
        """Those who can give way; where all bodies are, those first, (n, 6); and the discs (d, 6) of each."""
        followers: list[Follower] = []
        groups: list[np.ndarray] = []  # (bodies, discs of each, 6)
        others: list[np.ndarray] = []
        for population in self._populations:
            each, discs = population.followers(), population.in_the_way()
            if len(discs):
                followers += each
                (groups if each else others).append(discs.reshape(len(each) or len(discs), -1, 6))
        groups += others
        rows = np.concatenate([np.empty((0, 6)), *(group[:, group.shape[1] // 2] for group in groups)])
        return followers, rows, [discs for group in groups for discs in group]

    def _chosen(
        self, course: Course, discs: int, there: np.ndarray, radii: np.ndarray, halts: bool
    ) -> Options:
        """The option that costs least; ``halts``: also for one that does not halt easily."""

        def meeting(option: Options) -> tuple[int, float]:
            """When it would come too near to somebody, and what that costs."""
            points = course.points
            if option.shift is not None:
                points = points.copy()
                points[:, :2] += option.shift
            places = _places(course, points, option.pace, discs)
            met = first_meeting(places, course.radius, there, radii, ROOM)
            return met[0], cost_of_meeting(*met)

        onward = Options(1.0, None, 0.0)
        first, least = meeting(onward)
        if first >= COUNT:
            return onward
        best = onward
        for option in options(course, first, halts):
            if option.cost >= least:
                break
            cost = option.cost + meeting(option)[1]
            if cost < least and (option.shift is None or self._is_free(course, option.shift)):
                best, least = option, cost
        return best

    def _is_free(self, course: Course, shift: np.ndarray) -> bool:
        """Whether the way that a shift makes of a course stays on the surface, clear of its ends."""
        moved = np.flatnonzero(np.linalg.norm(shift, axis=1) > 0.02)
        points = course.points[moved].copy()
        points[:, :2] += shift[moved]
        return line_holds(self._level.graph, points, course.radius)


def _rushes(course: Course | None) -> bool:
    """Whether somebody does not halt easily."""
    return course is not None and course.slowest > 0.0


def _up_to_the_group(course: Course, others: np.ndarray) -> tuple[Course, np.ndarray]:
    """A course to a goal as far as those of the discs ``others`` (k, 6) who stand there let it, and these;
    it is not `Course.whole` if they are in its way."""
    group = who_stands_at(course.points[-1], course.radius, others)
    free = free_points(course, group) if len(group) else len(course.points)
    if free == len(course.points):
        return course, group
    free = max(free, 1)
    return replace(course, points=course.points[:free], speeds=course.speeds[:free], whole=False), group


def _places(course: Course, points: np.ndarray, pace: float, discs: int) -> np.ndarray:
    places = np.empty((COUNT, discs, 2))
    foretell(
        points, course.speeds, course.speed, pace, course.slowest, course.acceleration, course.braking,
        course.length, places,
    )  # fmt: skip
    return places


def _straight_on(discs: np.ndarray) -> np.ndarray:
    """(COUNT, d, 2) where discs (d, 6) are that go on as they do."""
    moments = STEP * np.arange(COUNT)[:, None, None]
    return discs[None, :, :2] + moments * discs[None, :, 3:5]
