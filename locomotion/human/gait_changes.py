"""When a person goes over from one gait to another, and what it tries out before it does."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial

from locomotion.events import GotStuck
from locomotion.gaits.limits import run_entry_speed
from locomotion.human.person import Person
from locomotion.human.state import MOVING
from locomotion.paths.gait_plan import RUN_UP
from locomotion.rehearsal.deciding import Decider, Trial
from locomotion.rehearsal.trials import (
    BALKINGS,
    BRAKINGS,
    HOLDS,
    RUN_UPS,
    SETTING_OFF,
    SLOWINGS,
    STEPPINGS,
    ComesToRest,
    StepsOn,
    balk,
    clears,
    vary_run_up,
    walks_on,
)
from locomotion.rehearsal.understudy import Chooser, Understudy

__all__ = ["GaitChanges"]

_TOO_NEAR = 2.0  # [m] before an obstacle up to which a walking person comes
_AGAIN, _TRIES = 5, 40  # ticks after which one told to stop tries to brake again; in which it tries

_CLEARS = partial(clears, notes=True)
_WALKS_ON = partial(walks_on, notes=True)


def _slow_down(body: Chooser, deceleration: float) -> None:
    body.slow_down(deceleration)


def _brake(body: Chooser, harder: float) -> None:
    body.brake(harder)


def _vary_step(body: Chooser, longer: Sequence[float]) -> None:
    body.vary_step(longer)


class GaitChanges:
    """Of ``person``, who has ``decider`` choose among variations."""

    def __init__(self, person: Person, decider: Decider) -> None:
        self._person, self._decider = person, decider
        self._steps_on = StepsOn()

    # --- walking
    def run_if_due(self) -> None:
        """Go over from walking to running, just after a foot was put down."""
        person = self._person
        if person.status not in MOVING or not person.follower.runs or person.follower.pace < 1.0:
            return
        run_up, arc = person.run_up, person.arc_length
        near = run_up.comes_within(arc, _TOO_NEAR)
        if (near or run_up.balked) and person.go_back():
            return
        if near:
            ahead = run_up.ahead
            assert ahead is not None
            reason = f"it finds no run-up to the {ahead.affordance} of {ahead.size:.2f} m"
            person.end("stuck", GotStuck(person.time, person.point, reason=reason))
            return
        speed = run_entry_speed(person.on_feet.walk, person.control, float(person.command[0]))
        if speed is None or person.go_back():
            return
        if not run_up.comes_within(arc, RUN_UP):
            person.run(False, speed)
            return

        def set_off(body: Chooser, choice: tuple[bool, Sequence[float]]) -> None:
            body.set_off(choice, speed)

        choice, went, seen = self._decider.best(person, SETTING_OFF, set_off, _CLEARS)
        if went >= HOLDS:
            person.set_off(choice, speed)
            self._decider.predicted.expect(person, seen)

    def choose_step(self) -> None:
        """Just after a foot was put down on uneven ground: choose how long the next step takes."""
        person = self._person
        if person.on_feet.begins_uneven_step:
            choice, _, seen = self._decider.best(person, STEPPINGS, _vary_step, self._steps_on)
            person.vary_step(choice)
            self._decider.predicted.expect(person, seen)

    # --- running
    def walk_if_due(self) -> None:
        """Where it is to stand, or cannot slow down in time, brake; where the path is not run, slow down;
        and go over to walking when it can."""
        person, feet, follower = self._person, self._person.on_feet, self._person.follower
        told = person.status == "standing"
        stops = told or follower.pace == 0.0 or follower.brakes
        if stops and not feet.brakes and self._brakes_or_will(told):
            return
        if feet.slowing == 0.0:
            if person.status not in MOVING or not follower.runs or follower.pace == 0.0:
                self._slow_down_or_will(stops)
        if feet.walk_if_slow(person.index, person.control, person.data) and person.status in MOVING:
            person.status = "walking"

    def choose_take_off(self) -> None:
        """Just after a step of a run-up has begun: choose among its variations, or break it off."""
        person = self._person
        if not person.begins_run_up:
            return
        if self._decider.answer is None:
            self._decider.undecided = True
            return
        choice, went, seen = self._decider.best(person, RUN_UPS, vary_run_up, _CLEARS)
        person.run_up.vary(choice, person.control, went >= HOLDS)
        if went >= HOLDS:
            self._decider.predicted.expect(person, seen)
        else:
            self._slow_as_rehearsed(BALKINGS, balk, _WALKS_ON)

    def _brakes_or_will(self, told: bool) -> bool:
        """Whether it begins to brake, because that goes well, or, if it was ``told`` to stop just now or has
        just come to where it is to brake, will try it again in a moment. One that slows down meanwhile tries
        it again and again."""
        if self._decider.answer is None:
            return False
        person = self._person
        since, runs = person.ticks - person.ended_at, person.on_feet.slowing == 0.0
        may_wait = runs and (since < _TRIES if told else person.follower.begins_to_slow)
        now = (since if told else person.ticks) % _AGAIN == 1 or (runs and not may_wait)
        return (now and self._brakes_well()) or may_wait

    def _slow_down_or_will(self, must: bool) -> None:
        """Slow down to a walk; where that does not go well, brake, or run on for a moment if it need not."""
        follower, ticks = self._person.follower, self._person.ticks
        may_wait = not must and self._decider.answer is not None and follower.begins_to_slow
        if may_wait and follower.tried_to_slow and ticks - follower.tried_to_slow < _AGAIN:
            return
        if self._slow_as_rehearsed(SLOWINGS, _slow_down, _WALKS_ON):
            return
        if not must and self._brakes_well():
            return
        if may_wait:
            follower.tried_to_slow = ticks
        else:
            self._person.slow_down(SLOWINGS[0])

    def _brakes_well(self) -> bool:
        """Whether it begins to brake, because that goes well."""
        return self._slow_as_rehearsed(BRAKINGS, _brake, ComesToRest())

    def _slow_as_rehearsed(
        self,
        decelerations: Sequence[float],
        slow: Callable[[Chooser, float], None],
        goes_well: Callable[[Understudy], Trial],
    ) -> bool:
        """Slow down in the way that goes well, if there is one; gives whether there is."""
        deceleration, went, seen = self._decider.best(self._person, decelerations, slow, goes_well)
        if went > 0.0:
            slow(self._person, deceleration)
            self._decider.predicted.expect(self._person, seen)
        return went > 0.0
