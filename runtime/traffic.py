"""Bodies that follow paths, dogs and people, give way to each other and to everybody else."""

from collections.abc import Sequence

import numpy as np

from locomotion.giving_way import (
    COUNT,
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
_ROOM = 0.08  # [m] that bodies keep between each other besides
_SLACK = 3.5  # [m] between two that go straight on, from which what they do is looked at closely
_STOREY = 1.5  # [m] of height from which bodies are on different storeys
_AT_REST = 0.05  # [m/s]


class Traffic:
    """Lets the followers among ``populations`` give way, one after the other in order of their making.

    All that is remembered between choices is kept in the bodies: their paths and paces.
    """

    def __init__(self, level: Level, populations: Sequence[Population]) -> None:
        self._level, self._populations = level, populations

    def direct(self, tick: int) -> None:
        """Let those choose whose turn it is; called before every `EVERY`th ``tick``."""
        followers, rows, discs = self._gather()
        if not followers or len(rows) < 2:
            return
        near = meetings(
            rows[:, :2].copy(),
            rows[:, 3:5].copy(),
            rows[:, 2].copy(),
            np.arange(len(followers)),
            _SLACK,
            _STOREY,
        )
        wanted = near.any(axis=1)
        wanted |= np.array([each.pace < 1.0 for each in followers])
        wanted &= np.arange(len(followers)) % _TURNS == tick // EVERY % _TURNS
        told: dict[int, np.ndarray] = {}
        courses: dict[int, Course | None] = {}

        def course_of(index: int) -> Course | None:
            if index not in courses:
                courses[index] = followers[index].course()
            return courses[index]

        def foretold(index: int) -> np.ndarray:
            """(COUNT, d, 2) where a body will be."""
            if index not in told:
                course = course_of(index) if index < len(followers) else None
                if course is None:
                    told[index] = _straight_on(discs[index])
                else:
                    told[index] = _places(course, course.points, course.pace, len(discs[index]))
            return told[index]

        for index in np.flatnonzero(wanted).tolist():
            course = course_of(index)
            if course is None:
                continue
            others = np.array([j for j in np.flatnonzero(near[index]) if not _on_goal(course, discs[int(j)])])
            # who halts at once gives way to who does not
            halts = any(other < len(followers) and _rushes(course_of(int(other))) for other in others)
            if len(others):
                there = np.concatenate([foretold(int(other)) for other in others], axis=1)
                radii = np.concatenate([discs[int(other)][:, 5] for other in others])
            else:
                there, radii = np.empty((COUNT, 0, 2)), np.empty(0)
            chosen = self._chosen(course, len(discs[index]), there, radii, halts)
            if chosen.shift is not None or chosen.pace != course.pace:
                followers[index].give_way(chosen.pace, chosen.shift)
                courses.pop(index, None)
                told.pop(index, None)

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
        radius = course.radius + _ROOM

        def meeting(option: Options) -> int:
            points = course.points
            if option.shift is not None:
                points = points.copy()
                points[:, :2] += option.shift
            return first_meeting(_places(course, points, option.pace, discs), radius, there, radii)

        onward = Options(1.0, None, 0.0)
        first = meeting(onward)
        if first >= COUNT:
            return onward
        best, least = onward, cost_of_meeting(first)
        for option in options(course, first, halts):
            if option.cost >= least:
                break
            cost = option.cost + cost_of_meeting(meeting(option))
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


def _on_goal(course: Course, discs: np.ndarray) -> bool:
    """Whether somebody at rest stands where a course ends: it goes there all the same."""
    if np.abs(discs[:, 3:5]).max() > _AT_REST:
        return False
    away = np.linalg.norm(discs[:, :2] - course.points[-1, :2], axis=1)
    return bool(np.any(away < discs[:, 5] + course.radius + _ROOM))


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
