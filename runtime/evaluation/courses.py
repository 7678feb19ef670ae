"""What happens when a person runs over a straight course of obstacles."""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from locomotion import MOVING, Ground, Human
from locomotion.body_events import Cleared, TookOff
from locomotion.rehearsal.choices import REHEARSALS
from locomotion.rehearsal.contact_report import ContactReport, Watcher
from locomotion.skills.course import AFTER, Course, make_course
from locomotion.skills.interface import ClearingSkill
from locomotion.skills.registry import skill_kind

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

SPEED = 3.5
"""[m/s] asked for on the way."""
_SLOWEST = 0.5  # [m/s]: who is slower over the whole course has not made it
_FALLEN = ("in the run-up", "in the skill", "afterwards")


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
    rehearsal_ticks: int | None = None,
) -> CourseRun:
    """Run over a course from standing, on the level's triangles, pushed once if there is a ``push``.
    rehearsal_ticks: as of `runtime.World`; None: as many as it needs at the moment. Other arguments as of
    `enter_course`."""
    human = enter_course(course, clearing, noise, rehearsals)
    human.waits = rehearsal_ticks is None
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
        if rehearsal_ticks is not None:
            human.look_ahead(rehearsal_ticks)
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
