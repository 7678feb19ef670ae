"""When a person changes gait, and what it rehearses before."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import partial

from locomotion.body_events import GotStuck
from locomotion.gaits.limits import RUN_ENTRY, SHORT_ENTRY, run_entry_speed
from locomotion.gaits.run.layout import STEP_TIME
from locomotion.ground.ground import SLIPPERY
from locomotion.human.composition import HOPELESS, Composition
from locomotion.human.person import Person
from locomotion.human.state import MOVING
from locomotion.paths.command import HEADING_ASKED
from locomotion.paths.gait_plan import RUN_UP
from locomotion.rehearsal.choices import (
    BALKINGS,
    BRAKINGS,
    ENDINGS,
    HASTES,
    HOLDS,
    HOLDS_FULLY,
    RESTS_IN,
    RUN_UPS,
    SETTING_OFF,
    SLIPPERY_SLOWINGS,
    SLOWINGS,
    STEPPINGS,
    STEPS_IN,
    WALKS_IN,
    clears_in,
)
from locomotion.rehearsal.deciding import RECONSIDERS, Decider, Trial
from locomotion.rehearsal.trials import ComesToRest, StepsOn, balk, clears, vary_run_up, walks_on
from locomotion.rehearsal.understudy import Chooser, Understudy

__all__ = ["GaitChanges"]

_TOO_NEAR = 2.0  # [m] before an obstacle at which a walking person stops
_BESIDE = 1.5  # [m] beside its path at which nobody begins a run-up
_TRIES = 40  # ticks after a stop command in which it attempts to brake
_SURE = 3.2  # [m/s] up to which braking mostly holds unrehearsed
_SAME = 1e-9  # [m/s²]
_LOOKS_AGAIN = 2 * RECONSIDERS  # ticks between attempts to slow down in another way: longer to rehearse

_CLEARS = partial(clears, notes=True)
_WALKS_ON = partial(walks_on, notes=True)


def _slow_down(body: Chooser, deceleration: float) -> None:
    body.slow_down(deceleration)


def _end_run(body: Chooser, _: bool) -> None:
    body.end_run()


def _brake(body: Chooser, harder: float) -> None:
    body.brake(harder)


def _vary_step(body: Chooser, longer: Sequence[float]) -> None:
    body.vary_step(longer)


class GaitChanges:
    """Gait changes of ``person``; ``decider`` chooses among variations, or ``composition`` without
    rehearsals."""

    def __init__(self, person: Person, decider: Decider, composition: Composition) -> None:
        self._person, self._decider, self._composition = person, decider, composition
        self._steps_on = StepsOn()

    # --- walking
    def run_if_due(self) -> None:
        """Change from walking to running, just after a foot came down."""
        person = self._person
        if person.on_feet.walks_as_learned:
            return  # the planned walk begins the run
        if person.status not in MOVING or not person.follower.runs or person.follower.pace < 1.0:
            return
        run_up, arc = person.run_up, person.arc_length
        near = run_up.comes_within(arc, _TOO_NEAR)
        if (near or run_up.balked) and person.go_back():
            return
        if near:
            ahead = run_up.ahead
            assert ahead is not None
            reason = f"it finds no run-up to the {ahead.affordance} of {person.size * ahead.size:.2f} m"
            person.end("stuck", GotStuck(person.time, person.point, reason=reason))
            return
        heading = float(person.command[HEADING_ASKED])
        least = SHORT_ENTRY if run_up.has_little_room(arc) else RUN_ENTRY
        speed = run_entry_speed(person.on_feet.walk, person.observed, heading, least)
        if speed is None or person.go_back():
            return
        if speed < RUN_ENTRY and self._decider.answer is None:
            self._decider.undecided = True  # only one that rehearses begins so slowly
            return
        if not run_up.comes_within(arc, RUN_UP):
            person.run(False, speed)
            return
        if abs(person.lateral_error) > _BESIDE:
            return
        self._set_off(speed)

    def _set_off(self, speed: float) -> None:
        """Begin to run towards the obstacle ahead, from ``speed`` [m/s], if rehearsals hold; from less than
        usual, because there is little room, only if they hold in full."""
        person, rehearses = self._person, self._decider.answer is not None
        if not rehearses and not self._composition.dares_to_set_off():
            return

        def set_off(body: Chooser, choice: tuple[bool, Sequence[float], float]) -> None:
            quickly, run_up, ahead = choice
            body.set_off((quickly, run_up), speed + ahead)

        choices, least = (SETTING_OFF, HOLDS) if speed >= RUN_ENTRY else (HASTES, HOLDS_FULLY)
        if self._slips:
            choices = sorted(choices, key=lambda choice: choice[0])  # not quickly first
        choice, went, seen, known = self._decider.best(person, choices, set_off, _CLEARS, self._clears_in)
        if went >= least and (known or not rehearses):
            set_off(person, choice)
            self._decider.predicted.expect(person, seen)

    def choose_step(self) -> None:
        """Just after a foot of a strained person came down on uneven ground: choose the duration of the next
        step."""
        person = self._person
        if person.on_feet.begins_strained_step:
            choice, _, seen, _ = self._decider.best(person, STEPPINGS, _vary_step, self._steps_on, STEPS_IN)
            person.vary_step(choice)
            self._decider.predicted.expect(person, seen)

    # --- running
    def walk_if_due(self) -> None:
        """Brake before a stop, or if it cannot slow down in time; slow down where the path is not run; and
        change to walking when possible."""
        person, feet, follower = self._person, self._person.on_feet, self._person.follower
        told = person.status == "standing"
        stops = told or follower.pace == 0.0 or follower.brakes
        if not feet.brakes:
            follower.stops_since = (follower.stops_since or person.ticks) if stops else 0
            if stops and self._brakes_or_will(told):
                return
        elif feet.slowing > 0.0 and follower.stops_since:
            self._brake_better()
        if feet.slowing > 0.0 and not feet.brakes and follower.tried_to_slow:
            self._slow_down_better()
        if feet.slowing == 0.0:
            slows = person.status not in MOVING or not follower.runs or follower.pace == 0.0
            if slows and not self._ends_as_learned_or_will(stops):
                self._slow_down_or_will(stops)
        if feet.walk_if_slow(person.index, person.control, person.data) and person.status in MOVING:
            person.status = "walking"

    def choose_take_off(self) -> None:
        """Just after a step of a run-up has begun: choose its variation, or abort the run-up."""
        person = self._person
        if self._decider.answer is None and self._composition.bravery is not None:
            self._composition.choose_take_off(self._composition.needs)
        if not person.begins_run_up:
            return
        if self._decider.answer is None:
            self._decider.undecided = True
            return
        hopeless = self._composition.hopeless()
        if hopeless is not None and self._slow_as_rehearsed(BALKINGS, balk, _WALKS_ON, WALKS_IN):
            person.events.append(hopeless)
            return
        choice, went, seen, known = self._decider.best(person, RUN_UPS, vary_run_up, _CLEARS, self._clears_in)
        if not known:
            self._composition.choose_take_off(HOPELESS)
            return
        person.run_up.vary(choice, person.control, went >= HOLDS)
        if went >= HOLDS:
            self._decider.predicted.expect(person, seen)
        else:
            self._slow_as_rehearsed(BALKINGS, balk, _WALKS_ON, WALKS_IN)

    @property
    def _clears_in(self) -> int:
        """Ticks of a trial that clears the obstacle ahead."""
        ahead = self._person.run_up.ahead
        assert ahead is not None
        return clears_in(ahead.arc_length - self._person.arc_length)

    def _ends_as_learned_or_will(self, stops: bool) -> bool:
        """End the run as learned if a foot has just come down; return whether it does, or will try at the
        next step."""
        person, feet, follower = self._person, self._person.on_feet, self._person.follower
        if feet.landing.acts or not feet.can_end_run(person.simulation):
            return False
        if person.control[STEP_TIME] != 0.0:
            return True
        goes_well, takes = (ComesToRest(), RESTS_IN) if stops else (_WALKS_ON, WALKS_IN)
        _, went, seen, known = self._decider.best(person, ENDINGS, _end_run, goes_well, takes)
        since = person.ticks - follower.stops_since
        may_wait = since < _TRIES if stops else follower.begins_to_slow
        if not known and self._decider.answer is not None and may_wait:
            return True
        if went > 0.0:
            person.end_run()
            self._decider.predicted.expect(person, seen)
        return went > 0.0

    def _brakes_or_will(self, told: bool) -> bool:
        """Try to brake; return whether it does, or will try again shortly.

        If rehearsals fail but the person was just ``told`` to stop, or has just reached its braking point, it
        waits for the next attempt; so does one that is too fast to brake without a rehearsal. One that slows
        down meanwhile keeps trying.
        """
        if self._decider.answer is None:
            return False
        person = self._person
        since, runs = person.ticks - person.follower.stops_since, person.on_feet.slowing == 0.0
        unsure = not self._decider.waits and math.hypot(person.velocity[0], person.velocity[1]) > _SURE
        may_wait = runs and (since < _TRIES if told or unsure else person.follower.begins_to_slow)
        now = since % self._decider.again == 0 or (runs and not may_wait)
        return (now and self._brakes_well(unsure and may_wait)) or may_wait

    def _brake_better(self) -> None:
        """If it brakes as it has not rehearsed, brake otherwise if that does not hold."""
        person = self._person
        if (person.ticks - person.follower.stops_since) % self._decider.again:
            return
        learned = person.on_feet.brake_skill.deceleration
        ways = sorted(BRAKINGS, key=lambda harder: abs(harder * learned - person.on_feet.slowing) > _SAME)
        self._slow_as_rehearsed(ways, _brake, ComesToRest(), RESTS_IN)

    def _slow_down_better(self) -> None:
        """If it slows down as it has not rehearsed, do so otherwise, or brake, if that does not hold."""
        person = self._person
        since = person.ticks - person.follower.tried_to_slow
        if self._decider.answer is None or since == 0 or since % _LOOKS_AGAIN:
            return
        now = person.on_feet.slowing
        ways = (now, *(each for each in self._slowings if each != now))
        if not self._slow_as_rehearsed(ways, _slow_down, _WALKS_ON, WALKS_IN):
            self._slow_as_rehearsed(BRAKINGS, _brake, ComesToRest(), RESTS_IN)

    @property
    def _slowings(self) -> Sequence[float]:
        return SLIPPERY_SLOWINGS if self._slips else SLOWINGS

    @property
    def _slips(self) -> bool:
        """Whether its feet slip where it speeds up or slows down quickly."""
        return self._person.simulation.grip < SLIPPERY

    def _slow_down_or_will(self, must: bool) -> None:
        """Slow down to a walk, at once if there was no time to rehearse it; if rehearsals fail, brake, or run
        on for a moment if there is room."""
        follower, ticks = self._person.follower, self._person.ticks
        may_wait = not must and self._decider.answer is not None and follower.begins_to_slow
        if may_wait and follower.tried_to_slow and ticks - follower.tried_to_slow < self._decider.again:
            return
        if self._slow_as_rehearsed(self._slowings, _slow_down, _WALKS_ON, WALKS_IN):
            return
        if not must and self._brakes_well(may_wait):
            return
        if not may_wait:
            self._person.slow_down(self._slowings[0])
        if self._decider.answer is not None:
            follower.tried_to_slow = ticks

    def _brakes_well(self, may_wait: bool) -> bool:
        """Brake if rehearsals succeed; return whether it does. ``may_wait``: see `_slow_as_rehearsed`."""
        return self._slow_as_rehearsed(BRAKINGS, _brake, ComesToRest(), RESTS_IN, may_wait)

    def _slow_as_rehearsed(
        self,
        decelerations: Sequence[float],
        slow: Callable[[Chooser, float], None],
        goes_well: Callable[[Understudy], Trial],
        takes: int,
        may_wait: bool = False,
    ) -> bool:
        """Slow down in a way that succeeds in rehearsal; return whether there is one. What has not been
        rehearsed is done only if it may not wait."""
        person = self._person
        deceleration, went, seen, known = self._decider.best(person, decelerations, slow, goes_well, takes)
        does = went > 0.0 and (known or not may_wait)
        if does:
            since = person.follower.stops_since
            slow(person, deceleration)
            self._decider.predicted.expect(person, seen)
            if not known and self._decider.answer is not None:  # it will see whether that holds
                began = person.ticks if person.on_feet.brakes else 0
                person.follower.stops_since, person.follower.tried_to_slow = since or began, person.ticks
        return does
