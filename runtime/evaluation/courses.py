"""Straight courses of obstacles as levels of triangles, and what happens when a person runs over one."""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from locomotion import MOVING, Ground, Human, ObstacleAhead
from locomotion.body_events import Cleared, TookOff
from locomotion.ground.ground import extruded
from locomotion.rehearsal.contact_report import ContactReport, Watcher
from locomotion.rehearsal.trials import REHEARSALS
from locomotion.skills.interface import ClearingSkill
from locomotion.skills.registry import skill_kind
from navmesh.obstacles.kinds import kind_of

__all__ = [
    "AFTER",
    "ContactReport",
    "Course",
    "CourseRun",
    "Push",
    "enter_course",
    "held",
    "make_course",
    "run_course",
]

AFTER = 15.0
"""[m] from the last obstacle to the goal."""
SPEED = 3.5
"""[m/s] asked for on the way."""
_SLOWEST = 0.5  # [m/s]: who is slower over the whole course has not made it
_HALF = 5.0  # [m] of the course's width
_PIT = 3.0  # [m] of depth of a gap
_EDGE = 1e-3  # [m] of the path on both sides of an edge
_FALLEN = ("in the run-up", "in the skill", "afterwards")


@dataclass(frozen=True)
class Course:
    """A course along x. vertices (v, 3), faces (f, 3): the level. path (n, 3) [m]: along its middle, from the
    start to the goal. obstacles: what the path crosses, in order."""

    vertices: NDArray[np.float64]
    faces: NDArray[np.int64]
    path: NDArray[np.float64]
    obstacles: tuple[ObstacleAhead, ...]


@dataclass(frozen=True)
class Push:
    """A force (2,) [N] on the pelvis for ``ticks``, from when the centre of mass has come to x = ``at``
    [m]."""

    at: float
    force: NDArray[np.float64]
    ticks: int


@dataclass
class CourseRun:
    """A run over a course. ended: "arrived", or the status at the end, "fallen" with where; reports: of the
    obstacles that the person took off for, in order. seconds: simulated [s]. frames: qpos (46,) of each
    tick, if they were asked for."""

    ended: str = ""
    seconds: float = 0.0
    reports: list[ContactReport] = field(default_factory=list)
    frames: list[NDArray[np.float64]] = field(default_factory=list)


def make_course(
    obstacles: Sequence[tuple[str, float, float]], distances: Sequence[float], margin: float = 5.0
) -> Course:
    """A course of ``obstacles``, each (affordance, height (gap: width) [m], thickness [m]), ``distances`` [m]
    after the start and after each other. Thickness is that of what one gets over; elsewhere it does not
    count."""
    x = z = 0.0
    profile, path, ahead = [(-margin, 0.0)], [(0.0, 0.0)], []
    for (affordance, size, thickness), distance in zip(obstacles, distances, strict=True):
        x += distance
        path.append((x - _EDGE, z))
        crossing = kind_of(affordance).crossing
        height, depth = {"over": (size, thickness), "across": (0.0, size)}.get(crossing, (size, 0.0))
        top = z + height if crossing != "off" else z
        edge = np.array([x, 0.0, top])
        ahead.append(ObstacleAhead(x, affordance, height, edge, np.array([-1.0, 0.0, 0.0]), depth))
        profile.append((x, z))
        if crossing == "over":
            profile += [(x, top), (x + depth, top), (x + depth, z)]
        elif crossing == "across":
            profile += [(x, z - _PIT), (x + depth, z - _PIT), (x + depth, z)]
        else:
            z += height if crossing == "onto" else -height
            profile.append((x, z))
        path.append((x + _EDGE, z))
    path.append((x + AFTER, z))
    profile.append((x + AFTER + margin, z))
    vertices, faces = extruded(profile, _HALF)
    points = np.array([[x, 0.0, z] for x, z in path])
    return Course(vertices, faces, points, tuple(ahead))


def enter_course(
    course: Course,
    clearing: Sequence[ClearingSkill] | None = None,
    noise: NDArray[np.float64] | None = None,
    rehearsals: int = REHEARSALS,
) -> Human:
    """A person that stands at the start of a course and is told to run over it.

    clearing: skills to use, None for the package's. noise: (45,) added to the velocities at the start [m/s,
    rad/s]. rehearsals: as of `Human`.
    """
    ground = Ground.from_arrays(course.vertices, course.faces)
    human = Human(ground, clearing=clearing, rehearsals=rehearsals)
    human.reset(course.path[0], 0.0)
    if noise is not None:
        human.data.qvel[:] += noise
    human.follow(course.path, SPEED, course.obstacles)
    return human


def run_course(
    course: Course,
    clearing: Sequence[ClearingSkill] | None = None,
    noise: NDArray[np.float64] | None = None,
    keep_frames: bool = False,
    rehearsals: int = REHEARSALS,
    push: Push | None = None,
) -> CourseRun:
    """Run over a course from standing, on the level's triangles, pushed once if there is a ``push``; other
    arguments as of `enter_course`."""
    human = enter_course(course, clearing, noise, rehearsals)
    longest = float(course.path[-1, 0]) / _SLOWEST
    run, seen, where = CourseRun(), 0, 0
    report: ContactReport | None = None
    watcher = Watcher(human.index, human.model)
    pushed = 0
    while human.status in MOVING and human.time < longest:
        if push is not None and human.com[0] >= push.at and pushed <= push.ticks:
            human.data.xfrc_applied[human.index.root, :2] = push.force if pushed < push.ticks else 0.0
            pushed += 1
        human.tick()
        if keep_frames:
            run.frames.append(human.qpos)
        for event in human.events[seen:]:
            if isinstance(event, TookOff):
                report, where = ContactReport(event.takeoff_error, event.speed_error), 1
                run.reports.append(report)
            elif isinstance(event, Cleared) and report is not None:
                report.cleared, where = True, 2
        seen = len(human.events)
        if report is not None and not report.cleared:
            watcher.look(human.data, course.obstacles[len(run.reports) - 1], report)
    run.ended = human.status if human.status not in MOVING else "too slow"
    run.seconds = human.time
    if run.ended == "fallen":
        run.ended += f" {_FALLEN[where]}"
    return run


def held(affordance: str, run: CourseRun) -> bool:
    """Whether a course with one obstacle ended at its goal, by the skill: who has to has held on."""
    if run.ended != "arrived" or not run.reports:
        return False
    return not skill_kind(affordance).holds_on or run.reports[0].held > 0.0
