"""All bodies of a world at one time, with predicted places, computed on demand."""

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from locomotion.avoidance.goal_occupancy import STOREY, free_points, who_stands_at
from locomotion.avoidance.yielding import COUNT, STEP, Course, foretell, meetings
from runtime.bodies.protocol import Follower, Population

__all__ = ["Snapshot", "foretold_on"]

_SOON = 5  # points ahead on a course that give its direction
_ABREAST = 0.2  # cosine beyond which another body is not ahead
_YIELDS, _AWAY = round(1.0 / STEP), 1e6
# steps for which walkers are predicted, since they step aside; where they are taken to be after that [m]
_SLACK = 3.5  # [m] between two bodies moving straight on within which they are examined closely


class Discs:
    """Of each body, by its number, its discs (d, 6); ``groups``: of bodies with equally many each
    (bodies, d, 6). No array is made for a body before somebody asks for it: there may be thousands."""

    def __init__(self, groups: Sequence[np.ndarray]) -> None:
        self.all = np.concatenate([np.empty((0, 6)), *(group.reshape(-1, 6) for group in groups)])
        counts = np.repeat([group.shape[1] for group in groups], [len(group) for group in groups])
        self.first = np.concatenate([[0], np.cumsum(counts, dtype=np.int64)])
        """Of each body the row of its first disc in ``all``; then how many there are."""

    def __len__(self) -> int:
        return len(self.first) - 1

    def __getitem__(self, index: int) -> np.ndarray:
        number = range(len(self))[index]  # below 0: from the end, as of a list
        return self.all[self.first[number] : self.first[number + 1]]

    def __iter__(self) -> Iterator[np.ndarray]:
        return (self[number] for number in range(len(self)))


class Snapshot:
    """``followers``: bodies that can give way; they come first in ``discs``, which holds for each body of
    ``populations`` its discs (d, 6), as in `Population.in_the_way`."""

    def __init__(self, populations: Sequence[Population]) -> None:
        self.followers: list[Follower] = []
        groups: list[np.ndarray] = []  # (bodies, discs of each, 6)
        others: list[np.ndarray] = []
        for population in populations:
            each, discs = population.followers(), population.in_the_way()
            if len(discs):
                self.followers += each
                (groups if each else others).append(discs.reshape(len(each) or len(discs), -1, 6))
        groups += others
        self._rows = np.concatenate([np.empty((0, 6)), *(group[:, group.shape[1] // 2] for group in groups)])
        self.discs = Discs(groups)
        self._courses: dict[int, Course | None] = {}
        self._groups: dict[int, np.ndarray] = {}
        self._told: dict[int, np.ndarray] = {}

    def __len__(self) -> int:
        return len(self.discs)

    def near(self, indices: np.ndarray) -> np.ndarray:
        """(k, n) bool: which of all bodies come near to those of ``indices`` (k,) if all go straight on."""
        rows = self._rows
        return meetings(
            rows[:, :2].copy(), rows[:, 3:5].copy(), rows[:, 2].copy(), indices, _SLACK, STOREY
        )  # fmt: skip

    def others(self, index: int) -> np.ndarray:
        """(k, 6) the discs of all other bodies."""
        first, end = self.discs.first[index : index + 2]
        return np.concatenate([self.discs.all[:first], self.discs.all[end:]])

    def course(self, index: int) -> Course | None:
        """The course of a follower as far as the bodies at its goal allow; not `Course.whole` if they are in
        its way."""
        if index not in self._courses:
            course, group = self.followers[index].course(), self._rows[:0]
            if course is not None and course.whole:
                group = who_stands_at(course.points[-1], course.radius, self.others(index))
                free = free_points(course, group) if len(group) else len(course.points)
                if free < len(course.points):
                    free = max(free, 1)
                    points, speeds = course.points[:free], course.speeds[:free]
                    course = replace(course, points=points, speeds=speeds, reach=0.0, whole=False)
            self._courses[index], self._groups[index] = course, group
        return self._courses[index]

    def group(self, index: int) -> np.ndarray:
        """(k, 6) the discs of the bodies at a follower's goal."""
        self.course(index)
        return self._groups[index]

    def are_of(self, group: np.ndarray) -> np.ndarray:
        """(n,) bool: which of all bodies have a disc where one of ``group`` (k, 6) is."""
        there = np.zeros(len(self.discs.all), np.bool_)
        for x, y in group[:, :2]:
            there |= (self.discs.all[:, 0] == x) & (self.discs.all[:, 1] == y)
        return np.logical_or.reduceat(there, self.discs.first[:-1])

    def gets_away(self, index: int, other: int) -> bool:
        """Whether a follower that overlaps another body moves on all the same, lest both wait for ever: of
        two followers the one that is ahead, or if abreast the first."""
        if other >= len(self.followers):
            return False
        own, its = self.discs[index], self.discs[other]
        apart = np.linalg.norm(own[:, None, :2] - its[None, :, :2], axis=2)
        deep = own[:, None, 5] + its[None, :, 5] - apart
        if deep.max() <= 0.0:
            return False
        mine, theirs = np.unravel_index(int(deep.argmax()), deep.shape)
        if len(own) > 1 and len(its) > 1:
            return bool((mine, index) < (theirs, other))
        there = its[theirs, :2] - own[mine, :2]
        leaves, follows = self._leaves(index, there), self._leaves(other, -there)
        return leaves and (index < other or not follows)

    def _leaves(self, index: int, there: np.ndarray) -> bool:
        """Whether a follower's path leads away from ``there`` (2,)."""
        course = self.course(index)
        if course is None:
            return False
        ahead = course.points[min(_SOON, len(course.points) - 1), :2] - course.points[0, :2]
        return bool(ahead @ there <= _ABREAST * np.linalg.norm(ahead) * np.linalg.norm(there))

    def forget(self, index: int) -> None:
        """Update after a follower has changed its course."""
        self._courses.pop(index, None)
        self._told.pop(index, None)

    def foretold(self, index: int) -> np.ndarray:
        """(COUNT, d, 2) where a body will be."""
        if index not in self._told:
            self._told[index] = self._foretell(index)
        return self._told[index]

    def _foretell(self, index: int) -> np.ndarray:
        discs = self.discs[index]
        if index < len(self.followers):
            follower, course = self.followers[index], self.course(index)
            if course is not None:
                # its nose must not hold back a body that it has come up behind
                length, reach = course.length - course.nose, max(course.reach - course.nose, 0.0)
                body = replace(course, length=length, reach=reach, nose=0.0)
                return foretold_on(body, course.points, course.pace, len(discs))
            planned = follower.foretold()
            if planned is not None:
                return planned
        moments = STEP * np.arange(COUNT)[:, None, None]
        return discs[None, :, :2] + moments * discs[None, :, 3:5]

    def all_foretold(self, indices: Sequence[int]) -> tuple[np.ndarray, np.ndarray]:
        """Where the discs of some bodies will be (COUNT, k, 2), and their radii (k,) [m]. Walkers are
        foreseen for a second only, since they step aside for others: whoever waited for a gap of `HORIZON`
        in a crowd would wait for ever."""
        follow = [index for index in indices if index < len(self.followers)]
        told = [self.foretold(index) for index in follow]
        walkers = np.array([index for index in indices if index >= len(self.followers)], np.int64)
        first, end = self.discs.first[walkers], self.discs.first[walkers + 1]
        rows = np.repeat(first - np.cumsum(end - first) + (end - first), end - first)
        theirs = self.discs.all[rows + np.arange(len(rows))]
        there = theirs[None, :, :2] + STEP * np.arange(COUNT)[:, None, None] * theirs[None, :, 3:5]
        there[_YIELDS:] = _AWAY
        radii = [self.discs[index][:, 5] for index in follow]
        return np.concatenate([*told, there], axis=1), np.concatenate([*radii, theirs[:, 5]])


def foretold_on(course: Course, points: np.ndarray, pace: float, discs: int) -> np.ndarray:
    """(COUNT, discs, 2) predicted places of a body on a course, or on its path changed to ``points``."""
    places = np.empty((COUNT, discs, 2))
    foretell(
        points, course.speeds, course.speed, pace, course.slowest, course.acceleration, course.braking,
        course.eagerness, course.length, course.reach, course.turns, places,
    )  # fmt: skip
    return places
