"""Try actions on a copy of the person before it takes them.

Whether a landing holds is nearly a matter of chance: a foot that lands 4 cm earlier or an entry 0.1 m/s
faster decides it. But the simulation is exact, so a second body, the understudy, can start from the present
state and tell. A person rehearses its take-offs, and how it slows from a run to a walk: it tries variations,
the smallest first, until one succeeds, and uses that. If undisturbed, the result is the same.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Generator, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Generic, NamedTuple, TypeVar

import mujoco
import numpy as np

from locomotion.body.person import CONTROL_DT
from locomotion.body_events import Cleared, TookOff, WentBack
from locomotion.gaits.walk.layout import LONGER, WALK_HEADING, WALK_SPEED
from locomotion.human.state import MOVING, HumanState, same
from locomotion.paths.gait_plan import RUN_UP, braking_length
from locomotion.rehearsal.choices import (
    BALKINGS,
    BRAKINGS,
    ENDINGS,
    RUN_UPS,
    RUNS_ON,
    SETTLED,
    SLIPPERY_SLOWINGS,
    SLOWINGS,
    STEPS_IN,
)
from locomotion.rehearsal.contact_report import ContactReport, Watcher
from locomotion.rehearsal.deciding import Outcome, Question, Trial, tick_unless_asked
from locomotion.rehearsal.understudy import Chooser, Understudy
from surefoot.pausing import pause

__all__ = [
    "STAYS_UP",
    "ComesToRest",
    "Rehearsal",
    "StepsOn",
    "at_once",
    "balk",
    "clears",
    "first_good",
    "vary_run_up",
    "walks_on",
]

_WALKING, _TURNING = round(4.0 / CONTROL_DT), round(7.0 / CONTROL_DT)
# ticks that it must stay up behind an obstacle if it walks on, and if it goes back for the next one
_TRAPPED = 0.25  # score if it clears an obstacle but finds no way to continue
_LOOKED_AT = 2  # variations tried for continuing: after a good landing most work, after a bad one none
_SLOWS_DOWN = (ENDINGS, SLOWINGS, SLIPPERY_SLOWINGS, BRAKINGS)
_ASKED = 8  # attempts to slow down behind an obstacle
_WATCHED = round(1.0 / CONTROL_DT)  # last ticks of these, in which it must not stagger
_STAGGERS = 0.2  # [m] nearer to or farther from its path: that much is staggering
_AT_REST = round(3.5 / CONTROL_DT)  # ticks that it must stand still after braking
_ASKEW = 0.5  # [rad] off its heading up to which it loses little time when it goes on
_SLOWEST = 0.1  # [m/s] of one that brakes
_FAILED = ("fallen", "lost", "stuck")
_LONGEST = round(16.0 / CONTROL_DT)
_HEADWAY, _LITTLE = 0.4, 0.3  # share of the way that it is to make meanwhile; [m] less
_RESTLESS = round(2.0 / CONTROL_DT)  # ticks after which it must not step where it is to stand

_T = TypeVar("_T")
_R = TypeVar("_R")
STAYS_UP = 0.5
"""Least score of a step after which a person stays up."""


def at_once(task: Generator[None, None, _R]) -> _R:
    """Outcome of a finished task."""
    while True:
        try:
            next(task)
        except StopIteration as end:
            return end.value
        pause()


class Rehearsal(Generic[_T]):
    """Trying the choices of a question until one succeeds perfectly. Else the first of the best is taken.

    Attributes:
      question: whose first ``most`` choices are tried.
      outcome: of the best choice so far.
      tried_for: ticks of the present trial so far; whoever runs the rehearsal adds them.
    """

    def __init__(self, question: Question, most: int | None = None) -> None:
        self.question = question
        self._choices = question.choices[:most]
        self._trying, self.tried_for = self._choices[0], 0
        self.outcome: Outcome[_T] = Outcome(self._trying, 0.0, [])

    def run(self, understudy: Understudy) -> Generator[None, None, Outcome[_T]]:
        """Advance the ``understudy`` tick by tick; returns the outcome."""
        state, _, choose, goes_well, _ = self.question
        for choice in self._choices:
            self._trying, self.tried_for = choice, 0
            understudy.restore_state(state)
            understudy.data.xfrc_applied[:] = 0.0
            choose(understudy, choice)
            went, seen = yield from goes_well(understudy)
            if went > self.outcome.went:
                self.outcome = Outcome(choice, went, seen)
            if went >= 1.0:
                break
        return self.outcome

    @property
    def needs(self) -> int:
        """Ticks until there is an answer, if what is being tried holds: at least 1."""
        return max(self.question.takes - self.tried_for, 1)

    @property
    def so_far(self) -> Outcome[_T]:
        """What to do if there is no time left: what has held, else what is being tried."""
        held = self.outcome.went > 0.0
        return self.outcome if held else Outcome(self._trying, 1.0, [], known=False)


def first_good(
    state: HumanState,
    understudy: Understudy,
    choices: Sequence[_T],
    choose: Callable[[Chooser, _T], None],
    goes_well: Callable[[Understudy], Trial],
) -> Generator[None, None, Outcome[_T]]:
    """The best of ``choices`` in ``state``, see `Rehearsal`; advances the ``understudy`` tick by tick."""
    return Rehearsal(Question(state, choices, choose, goes_well, 0)).run(understudy)


def clears(body: Understudy, looks_on: bool = True, notes: bool = False) -> Trial:
    """Whether it clears the obstacle ahead and stays up behind it: 1 if it touches nothing it should not.

    looks_on: whether its options at a near next obstacle count too. notes: whether to record its ticks until
    the next decision; its events are dropped. If it falls behind the obstacle because it did not decide how
    to slow down, it restarts from there and decides. If it takes off for a next obstacle before it could
    decide anything, it has to clear that as well. If it walks and then runs where no obstacle is near, which
    has no rehearsal of its own, it has to stay up running.
    """
    obstacle = body.obstacle_ahead
    assert obstacle is not None
    report, cleared_at, clean = ContactReport(), 0, True
    watcher: Watcher | None = None  # from where it takes off
    walked, walks_for, since = False, _WALKING, 0
    seen: list[HumanState] = []
    decided: HumanState | None = None  # before a decision behind the obstacle
    body.decider.undecided = False
    for tick in range(_LONGEST):
        body.events.clear()
        if looks_on and cleared_at and not body.decider.undecided:
            decided = body.save_state()
        body.tick()
        yield
        if _failed(body) or body.status == "standing":
            if (
                decided is not None
                and body.decider.undecided
                and (yield from slows_down_in_time(body, decided))
            ):
                return (1.0 if clean else 0.5), seen
            return 0.0, []
        if notes and not body.decider.undecided:
            seen.append(body.save_state())
        again = False
        for event in body.events:
            if isinstance(event, Cleared):
                cleared_at, since, clean = tick, tick, clean and report.clean(obstacle.affordance)
            elif isinstance(event, TookOff):
                watcher, again = watcher or Watcher(body.index, body.model), cleared_at > 0
                if again and not body.decider.undecided and body.obstacle_ahead is not None:
                    obstacle, report, cleared_at, again = body.obstacle_ahead, ContactReport(), 0, False
            elif isinstance(event, WentBack):
                walks_for = _TURNING
        if cleared_at:
            walks = body.gait_now == "walk"
            if walked and not walks:
                again |= _runs_at_an_obstacle(body)
                since = tick
            walked = walks
            good = 1.0 if clean else 0.5
            if looks_on and body.begins_run_up and body.hemmed_in:
                goes_on = yield from finds_a_way_on(body)
                return (good if goes_on else _TRAPPED), seen
            if again or tick - since >= (walks_for if walks else RUNS_ON) or body.held:
                return good, seen
        elif watcher is not None:
            watcher.look(body.data, obstacle, report)
    return 0.0, []


def _runs_at_an_obstacle(body: Understudy) -> bool:
    """Whether a run that begins now is a run-up, which has its own rehearsal."""
    ahead = body.obstacle_ahead
    return ahead is not None and ahead.arc_length - body.follower.arc_length < RUN_UP


def vary_run_up(body: Chooser, choice: Sequence[float]) -> None:
    """Take one of `RUN_UPS`."""
    body.vary_run_up(choice)


def balk(body: Chooser, deceleration: float) -> None:
    """Take one of `BALKINGS`."""
    body.balk(deceleration)


def finds_a_way_on(body: Understudy) -> Generator[None, None, bool]:
    """Whether one that begins a run-up without looking further clears the obstacle, or can abort."""
    state, goes_on = body.save_state(), partial(clears, looks_on=False)
    best = yield from first_good(state, body, RUN_UPS[:_LOOKED_AT], vary_run_up, goes_on)
    if best.went > 0.0:
        return True
    best = yield from first_good(state, body, BALKINGS[:_LOOKED_AT], balk, walks_on)
    return best.went > 0.0


def slows_down_in_time(body: Understudy, state: HumanState) -> Generator[None, None, bool]:
    """Whether one about to slow down in ``state`` finds a way to slow down or brake that succeeds. Tries
    fewer variations than at the moment itself."""
    answers: list[tuple[Question, Outcome]] = []
    for _ in range(RUNS_ON):
        body.restore_state(state)
        body.events.clear()
        question = tick_unless_asked(body, answers)
        yield
        if question is None:
            if _failed(body):
                return False
            state = body.save_state()
        elif question.choices not in _SLOWS_DOWN or len(answers) == _ASKED:
            return False
        else:
            _, choices, choose, goes_well, _ = question
            outcome = yield from first_good(question.state, body, choices[:_LOOKED_AT], choose, goes_well)
            if outcome.went > 0.0:
                return True
            answers.append((question, outcome))
    return False


@dataclass
class ComesToRest:
    """Whether a braking body ends up standing, and in how little room [m], there and back: 1 if in no more
    than plans count on (`braking_length`), else 1 / (1 + room), much less if it ends facing away from its
    direction of travel; with its recorded ticks.

    within: best distance [m] so far; one that needs more is given up.
    """

    within: float = math.inf

    def __call__(self, body: Understudy) -> Trial:
        """Try it."""
        seen: list[HumanState] = []
        body.decider.undecided = False
        begun, velocity, way = body.com, body.velocity, 0.0
        planned = braking_length(math.hypot(velocity[0], velocity[1]))
        along = velocity / max(float(np.linalg.norm(velocity)), _SLOWEST)
        for _ in range(_AT_REST):
            body.events.clear()
            body.tick()
            yield
            if not body.decider.undecided:
                seen.append(body.save_state())
            now = float(along @ (body.com - begun))
            way = max(way, now)
            if _failed(body) or way >= self.within:
                return 0.0, []
            if body.on_feet.stands_still(body.control):
                askew = math.remainder(body.yaw - body.on_feet.walk[WALK_HEADING], 2.0 * math.pi)
                room = way + (way - now)
                if abs(askew) >= _ASKEW:
                    return 0.1 / (1.0 + room), seen
                self.within = min(self.within, room)
                return 1.0 if room <= planned else 1.0 / (1.0 + room), seen
        return 0.0, []


class _Moment(NamedTuple):
    """One tick of a trial on uneven ground."""

    state: HumanState
    undecided: bool  # whether it contained a decision
    left: float  # [m] of the way
    asked: float  # [m/s] wanted walking speed
    rests: bool


class StepsOn:
    """Whether a body walking on uneven ground stays up and makes progress, or comes to rest where it should:
    1; less for little progress or no rest; much less for a fall, the sooner the less. Includes its ticks
    recorded until the next decision. Drops the body's events.

    The best variation's ticks are kept: if the next step is not varied, they continue and need not be
    simulated again.
    """

    def __init__(self) -> None:
        self._model: mujoco.MjModel | None = None
        self._moments: list[_Moment] = []
        self._best = 0.0

    def __call__(self, body: Understudy) -> Trial:
        """Try it."""
        varied, left = bool(body.on_feet.walk[LONGER].any()), body.follower.remaining
        moments = self._known(body)
        if moments:
            body.become(moments[-1].state)
        for _ in moments:
            yield  # takes as many ticks as if they were not known
        while not (moments and _ends(moments[-1])) and len(moments) < STEPS_IN:
            body.events.clear()
            body.decider.undecided = False
            body.tick()
            yield
            rests = body.held or not body.on_feet.walks
            asked = abs(float(body.on_feet.walk[WALK_SPEED]))
            moments.append(
                _Moment(body.save_state(), body.decider.undecided, body.follower.remaining, asked, rests)
            )
        went = _headway(left, moments)
        if not varied or went > self._best:
            self._model, self._moments, self._best = body.model, moments, went
        known = itertools.takewhile(lambda at: not at.undecided and at.state.status not in _FAILED, moments)
        return went, [moment.state for moment in known]

    def _known(self, body: Understudy) -> list[_Moment]:
        """What will happen, as far as recorded."""
        if body.model is self._model:
            begun = body.save_state()
            for number, moment in enumerate(self._moments, 1):
                if moment.state.ticks == begun.ticks and same(moment.state, begun):
                    return self._moments[number:]
        return []


def _ends(moment: _Moment) -> bool:
    return moment.rests or moment.state.status in _FAILED


def _headway(left: float, moments: Sequence[_Moment]) -> float:
    """Its score; ``left``: [m] of path left at the beginning."""
    last = moments[-1]
    if last.state.status in _FAILED:
        return STAYS_UP * len(moments) / STEPS_IN
    if last.rests:
        return 1.0
    if sum(moment.state.status not in MOVING for moment in moments) > _RESTLESS:
        return STAYS_UP
    meant = _HEADWAY * sum(moment.asked for moment in moments) * CONTROL_DT - _LITTLE
    made = max(left - last.left, 0.0)
    return STAYS_UP + (1.0 - STAYS_UP) * (1.0 if made >= meant else made / meant)


def _failed(body: Understudy) -> bool:
    """Whether it fell, got lost or got stuck; one that overshot its goal can still return."""
    came_past = body.status == "lost" and body.follower.ended
    return body.status in _FAILED and not came_past


def walks_on(body: Understudy, notes: bool = False) -> Trial:
    """Whether a body that slows down comes to walk or stand, and stays up: 1 if it does not end staggering to
    one side, which would make it fall later. One that turns round for another run-up has to stay up for
    longer. ``notes``: whether to record its ticks. Its events are dropped.
    """
    seen: list[HumanState] = []
    walked, beside, walks_for = 0, 0.0, SETTLED
    body.decider.undecided = False
    for _ in range(_LONGEST):
        body.events.clear()
        body.tick()
        yield
        if notes and not body.decider.undecided:
            seen.append(body.save_state())
        if _failed(body):
            return 0.0, []
        if walked and body.gait_now == "run":
            return 1.0, seen[:-1]  # running again has its own rehearsal
        if body.held:
            return 1.0, seen
        if any(isinstance(event, WentBack) for event in body.events):
            walks_for = _TURNING
        if walked == walks_for - _WATCHED:
            beside = body.lateral_error
        if walked >= walks_for:
            return (1.0 if abs(body.lateral_error - beside) < _STAGGERS else 0.5), seen
        walked = walked + 1 if body.gait_now == "walk" else 0
    return 0.0, []
