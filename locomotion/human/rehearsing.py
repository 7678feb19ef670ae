"""A person that goes over from one gait to another, and tries out beforehand what comes of it."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from functools import partial
from typing import TYPE_CHECKING, TypeVar

from locomotion.events import GotStuck, WentBack
from locomotion.gaits.limits import run_entry_speed
from locomotion.ground.ground import Ground
from locomotion.human.moving import MovingPerson
from locomotion.human.on_feet import OnFeet
from locomotion.human.state import MOVING, HumanState
from locomotion.paths.gait_plan import RUN_UP
from locomotion.rehearsal.deciding import Question
from locomotion.rehearsal.lookahead import Foresight
from locomotion.rehearsal.predicted import Foreseen
from locomotion.rehearsal.rehearsal import (
    BALKINGS,
    BRAKINGS,
    HOLDS,
    RUN_UPS,
    SETTING_OFF,
    SLOWINGS,
    STEPPINGS,
    ComesToRest,
    Outcome,
    StepsOn,
    Trial,
    clears,
    walks_on,
)
from locomotion.skills.interface import ClearingSkill

if TYPE_CHECKING:
    from locomotion.human.human import Human

__all__ = ["RehearsingPerson"]

_TOO_NEAR = 2.0  # [m] before an obstacle up to which a walking person comes
_HEMMED_IN = 9.0  # [m] before an obstacle in which it may not come to a walk
_AGAIN, _TRIES = 5, 40  # ticks after which one told to stop tries to brake again; in which it tries
_SOON_WALKED, _SOON_RUN, _SOON_SLOWS = 2.5, 4.0, 1.5
# [m] before something is to be rehearsed from which it looks ahead: a run-up, walking, running; slowing down

_WALKS_ON = partial(walks_on, notes=True)

_T = TypeVar("_T")


class RehearsingPerson(MovingPerson, ABC):
    """See `locomotion.rehearsal.rehearsal`. ``rehearsals``: variations that it tries at one time at most, 0:
    none. ``decides``: how it rehearses; None: it does not, and ``undecided`` says whether
    there was something to be decided since that was set to False. ``foreseen``: what it knows of the next
    ticks."""

    def __init__(
        self, ground: Ground | None, on_feet: OnFeet, clearing: Sequence[ClearingSkill], rehearsals: int
    ) -> None:
        super().__init__(ground, on_feet, clearing)
        self._foresight = Foresight(rehearsals) if rehearsals else None
        self.decides: Callable[[RehearsingPerson, Question], Outcome] | None = None
        if self._foresight is not None:
            self.decides = self._foresight.decide
        self.undecided = False
        self.foreseen = Foreseen()
        self._steps_on = StepsOn()

    def restore_state(self, state: HumanState) -> None:
        """Continue from a state of a person on the same ground with the same skill."""
        self.become(state)
        self.foreseen.forget()

    # --- from one gait to the other
    def _run_if_due(self) -> None:
        """Go over from walking to running, just after a foot was put down."""
        if self.status not in MOVING or not self.way.runs or self.way.pace < 1.0:
            return
        obstacles, arc = self._obstacle_run, self.arc_length
        near = obstacles.comes_within(arc, _TOO_NEAR)
        if (near or obstacles.balked) and self._go_back():
            return
        if near:
            ahead = obstacles.ahead
            assert ahead is not None
            reason = f"it finds no run-up to the {ahead.affordance} of {ahead.size:.2f} m"
            self._end("stuck", GotStuck(self.time, self._point(), reason=reason))
            return
        speed = run_entry_speed(self.on_feet.walk, self._control, float(self._command[0]))
        if speed is None or self._go_back():
            return
        if not obstacles.comes_within(arc, RUN_UP):
            self.run(False, speed)
            return
        set_off = partial(RehearsingPerson.set_off, speed=speed)
        choice, went, seen = self._rehearse(SETTING_OFF, set_off, partial(clears, notes=True))
        if went >= HOLDS:
            self.set_off(choice, speed)
            self.foreseen.expect(self, seen)

    def set_off(self, choice: tuple[bool, Sequence[float]], speed: float) -> None:
        """Begin to run towards the obstacle ahead, from ``speed`` [m/s], in one of the ways of
        `rehearsal.SETTING_OFF`."""
        quickly, run_up = choice
        self.run(quickly, speed)
        self._obstacle_run.set_off(run_up, True)

    def _go_back(self) -> bool:
        """Whether it turns round, for a longer run-up to the obstacle ahead."""
        way = self.way
        to = None if way.interrupted is not None else self._obstacle_run.turning_point(way.arc, way)
        if way.path is None or to is None:
            return False
        ahead = self._obstacle_run.ahead
        assert ahead is not None
        back = WentBack(self.time, self._point(), ahead.affordance, ahead.size, way.arc - to)
        self.events.append(back)
        self._obstacle_run.go_back()
        way.go_back(to, self.on_feet.walk_limits, self._ticks)
        return True

    def run(self, quickly: bool, speed: float) -> None:
        """Go over from walking to running, from ``speed`` [m/s]."""
        self.on_feet.run(self._control, quickly, speed)
        self.status = "running"

    def _walk_if_due(self) -> None:
        """Where it is to stand, or cannot slow down in time, brake; where the path is not run, slow down;
        and go over to walking when it can."""
        told = self.status == "standing"
        stops = told or self.way.pace == 0.0 or self.way.brakes
        if stops and not self.on_feet.brakes and self._brakes_or_will(told):
            return
        if self.on_feet.slowing == 0.0:
            if self.status not in MOVING or not self.way.runs or self.way.pace == 0.0:
                self._slow_down_or_will(stops)
        if self.on_feet.walk_if_slow(self.index, self._control, self.data) and self.status in MOVING:
            self.status = "walking"

    def slow_down(self, deceleration: float) -> None:
        """Begin to slow down from the run to a walk [m/s^2]."""
        self.on_feet.slow_down(deceleration)

    def brake(self, harder: float) -> None:
        """Begin to brake, ``harder`` by that share than learned."""
        self.on_feet.slow_down(harder * self.on_feet.brake_skill.deceleration, brakes=True)

    def _brakes_or_will(self, told: bool) -> bool:
        """Whether it begins to brake, because that goes well, or, if it was ``told`` to stop just now or has
        just come to where it is to brake, will try it again in a moment. One that slows down meanwhile tries
        it again and again."""
        if self.decides is None:
            return False
        since, runs = self._ticks - self._ended_at, self.on_feet.slowing == 0.0
        may_wait = runs and (since < _TRIES if told else self.way.begins_to_slow)
        now = (since if told else self._ticks) % _AGAIN == 1 or (runs and not may_wait)
        return (now and self._brakes_well()) or may_wait

    def _slow_down_or_will(self, must: bool) -> None:
        """Slow down to a walk; where that does not go well, brake, or run on for a moment if it need not."""
        way = self.way
        may_wait = not must and self.decides is not None and way.begins_to_slow
        if may_wait and way.tried_to_slow and self._ticks - way.tried_to_slow < _AGAIN:
            return
        if self._slow_as_rehearsed(SLOWINGS, RehearsingPerson.slow_down, _WALKS_ON):
            return
        if not must and self._brakes_well():
            return
        if may_wait:
            way.tried_to_slow = self._ticks
        else:
            self.slow_down(SLOWINGS[0])

    def _brakes_well(self) -> bool:
        """Whether it begins to brake, because that goes well."""
        return self._slow_as_rehearsed(BRAKINGS, RehearsingPerson.brake, ComesToRest())

    # --- trying out
    def _rehearse_take_off(self) -> None:
        """Just after a step of a run-up has begun: choose among its variations, or break it off."""
        if not self.begins_run_up:
            return
        if self.decides is None:
            self.undecided = True
            return
        choice, went, seen = self._rehearse(
            RUN_UPS, RehearsingPerson.vary_run_up, partial(clears, notes=True)
        )
        self._obstacle_run.vary(choice, self._control, went >= HOLDS)
        if went >= HOLDS:
            self.foreseen.expect(self, seen)
        else:
            self._slow_as_rehearsed(BALKINGS, RehearsingPerson.balk, _WALKS_ON)

    def _rehearse_step(self) -> None:
        """Just after a foot was put down on uneven ground: choose how long the next step takes."""
        if self.on_feet.begins_uneven_step:
            choice, _, seen = self._rehearse(STEPPINGS, RehearsingPerson.vary_step, self._steps_on)
            self.vary_step(choice)
            self.foreseen.expect(self, seen)

    def vary_step(self, longer: Sequence[float]) -> None:
        """Make the step that has just begun, its transfer and its swing, take longer [s]."""
        self.on_feet.vary_step(longer)

    def _slow_as_rehearsed(
        self,
        decelerations: Sequence[float],
        slow: Callable[[RehearsingPerson, float], None],
        goes_well: Callable[[Human], Trial],
    ) -> bool:
        """Slow down in the way that goes well, if there is one; gives whether there is."""
        deceleration, went, seen = self._rehearse(decelerations, slow, goes_well)
        if went > 0.0:
            slow(self, deceleration)
            self.foreseen.expect(self, seen)
        return went > 0.0

    @property
    def begins_run_up(self) -> bool:
        """Whether a step of a run-up has just begun, and it was not rehearsed yet."""
        return self.on_feet.runs and self._obstacle_run.to_rehearse(self._control)

    @property
    def hemmed_in(self) -> bool:
        """Whether the next obstacle may be too near to slow down before it."""
        return self._obstacle_run.comes_within(self.arc_length, _HEMMED_IN)

    def vary_run_up(self, choice: Sequence[float]) -> None:
        """Plan the step of the run-up that has just begun with a mark that is farther from the obstacle [m],
        and an entry that is faster [m/s]."""
        self._obstacle_run.vary(choice, self._control, True)

    def balk(self, deceleration: float) -> None:
        """Break the run-up off, slowing down [m/s^2]."""
        self._obstacle_run.balk()
        self.slow_down(deceleration)

    @property
    def decides_soon(self) -> bool:
        """Whether it may come to something to be rehearsed within the next seconds."""
        way, feet, arc = self.way, self.on_feet, self.arc_length
        if feet.on_uneven_ground and not self._fours.active and not self.held:
            return True
        if way.path is None or self.status not in MOVING or self._fours.active or feet.slowing > 0.0:
            return False
        if feet.walks:
            begins = way.interrupted is None and way.path.runs(way.arc + _SOON_WALKED)
            turns = way.interrupted is not None and way.remaining < _SOON_WALKED
            return (begins or turns) and self._obstacle_run.rehearses_within(arc, _SOON_WALKED)
        ends = not self._obstacle_run.clearing and not way.path.runs(way.arc + _SOON_SLOWS)
        return ends or self._obstacle_run.rehearses_within(arc, _SOON_RUN)

    def _rehearse(
        self, choices: Sequence[_T], choose: Callable[[Human, _T], None], goes_well: Callable[[Human], Trial]
    ) -> Outcome[_T]:
        """The best of ``choices``, see `rehearsal.first_good`; without rehearsals the first is taken to go
        well. What was seen of it is there to be taken over, and not simulated again."""
        if self.decides is None:
            self.undecided = True
            return Outcome(choices[0], 1.0, [])
        return self.decides(self, Question(self.save_state(), choices, choose, goes_well))

    @abstractmethod
    def double(self) -> Human:
        """One that moves as it does, on the same ground, and does not rehearse."""
