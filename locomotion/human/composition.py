"""Giving control to a skill whose odds are good enough, and turning away from an obstacle otherwise.

A person without rehearsals that has a `bravery` asks the preconditions of its skills
(`locomotion.preconditions`): before it sets off for an obstacle, and at each step of its run-up, of each
variation of it. It takes the best variation. Where even that is not good enough, it turns away while it can
still come to a stand.

A person that rehearses asks for odds, too: where those of a run-up are `HOPELESS` it breaks that off, and it
goes by them at a step that it had no time to rehearse.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from locomotion.body_events import GotStuck, TurnedAway
from locomotion.errors import LocomotionError
from locomotion.gaits.run import controller
from locomotion.human.person import Person
from locomotion.paths.smoothing import ObstacleAhead
from locomotion.preconditions.changes import SLOW_DOWN, changing, describe_change
from locomotion.preconditions.features import FEATURES, before_run_up, describe, site_of
from locomotion.preconditions.moments import planned
from locomotion.preconditions.precondition import Precondition, load_preconditions
from locomotion.rehearsal.choices import BALKINGS, RUN_UPS
from locomotion.skills.interface import ClearingSkill, distance_to
from locomotion.skills.library import comes_with_package
from locomotion.skills.run_up_layout import FARTHER, FASTER
from surefoot.numeric import is_finite

__all__ = ["HOPELESS", "Composition", "checked_bravery"]

HOPELESS = 0.3
"""Odds in a run-up below which rehearsing how to go on is not worth it. There were 44 such steps in a
courtyard: for 43 the answer came too late, for the last one nothing held. On 14 courses of ten obstacles none
of 82 steps had odds so low."""
_TO_SET_OFF = 0.5
"""Share of the odds wanted in the run-up with which it sets off: it may still turn away."""
_BETTER = 0.02  # by which the odds of another variation have to be better
_SURE = (
    0.85  # odds of slowing down with which it turns away at this step; with less it waits for a better one
)
_WAY, _PER_DECELERATION, _MARGIN = 2.0, 0.8, 1.2
# [m] and [m²/s²] over the deceleration: way from a run-up to a walk; [m] more to a stand
_STEP = 1.2  # [m] at most, after which there may be no room any more


def checked_bravery(bravery: float | None) -> float | None:
    """``bravery``; raises `LocomotionError` if it is neither None nor a number from 0 to 1."""
    if bravery is not None and not (is_finite(bravery) and 0.0 <= bravery <= 1.0):
        raise LocomotionError(f"bravery must be a number from 0 to 1, or None, not {bravery!r}")
    return None if bravery is None else float(bravery)


class Composition:
    """Decides for ``person`` by odds."""

    def __init__(self, person: Person) -> None:
        self._person = person
        self.bravery: float | None = None
        self.preconditions: Mapping[str, Precondition] | None = None  # None: the package's

    @property
    def needs(self) -> float:
        """Odds, 0 to 1, below which it turns away."""
        return 0.0 if self.bravery is None else 1.0 - self.bravery

    def get_ready(self) -> None:
        """Read what is known of the package's skills. If that is out of date, since a skill has been learned
        anew, nothing is known, and rehearsals decide alone."""
        try:
            load_preconditions()
        except LocomotionError:
            self.preconditions = {}

    # --- asking
    def precondition(self, skill: ClearingSkill) -> Precondition | None:
        """What is known of one of its skills; None if nothing is, as of one's own."""
        known = self._known.get(skill.affordance)
        return known if self.preconditions is not None or comes_with_package(skill) else None

    @property
    def _known(self) -> Mapping[str, Precondition]:
        return load_preconditions() if self.preconditions is None else self.preconditions

    def odds(self, obstacle: ObstacleAhead, room: float) -> float | None:
        """Chance, 0 to 1, that it clears ``obstacle`` from where it is: none where that is beyond what its
        skill has learned; None if nothing is known. ``room``: [m] of way before the obstacle."""
        known = self.precondition(self._person.run_up.skill_for(obstacle))
        if known is None:
            return None
        if not known.covers(obstacle.size):
            return 0.0
        if self._in_run_up and obstacle is self._person.run_up.ahead:
            choice = self._person.run_up.plan[[FARTHER, FASTER]]
            return float(known.odds(self._described(obstacle, choice[None]))[0])
        return float(known.odds_before(before_run_up(self._site(obstacle), room)[None])[0])

    @property
    def _in_run_up(self) -> bool:
        person = self._person
        return person.on_feet.runs and person.run_up.planned > 0.0 and not person.run_up.clearing

    @property
    def grip(self) -> float:
        """Coefficient of friction of the ground that it reckons with."""
        return self._person.simulation.grip

    def _site(self, obstacle: ObstacleAhead) -> NDArray[np.float64]:
        return site_of(obstacle, self.grip)

    def _described(self, obstacle: ObstacleAhead, choices: NDArray[np.float64]) -> NDArray[np.float64]:
        """(k, n) features of the present moment, for each of ``choices`` (k, 2) of the run-up."""
        person, site = self._person, self._site(obstacle)
        run_up, rows = person.run_up, np.empty((len(choices), len(FEATURES)))
        memory = run_up.plan.copy()
        for choice, row in zip(choices, rows, strict=True):
            memory[[FARTHER, FASTER]] = choice
            skill, run = run_up.skill_for(obstacle), person.on_feet.run_skill
            plan = planned(person.control, obstacle, skill, run, memory, False)
            farther, faster = float(choice[0]), float(choice[1])
            describe(person.control, plan, farther, faster, person.lateral_error, site, row)
        return rows

    # --- deciding
    def dares_to_set_off(self) -> bool:
        """Whether a walking person runs at the obstacle ahead; if not, its way ends here."""
        person, obstacle = self._person, self._person.run_up.ahead
        if self.bravery is None or obstacle is None:
            return True
        odds = self.odds(obstacle, obstacle.arc_length - person.run_up.passed)
        if odds is None or odds >= _TO_SET_OFF * self.needs:
            return True
        person.events.append(TurnedAway(person.time, person.point, obstacle.affordance, obstacle.size, odds))
        person.end("stuck", GotStuck(person.time, person.point, reason=self._why_not(obstacle, odds)))
        return False

    def _why_not(self, obstacle: ObstacleAhead, odds: float) -> str:
        """Why it does not run at ``obstacle``, with these ``odds``."""
        size = self._person.size
        what = f"the {obstacle.affordance} of {size * obstacle.size:.2f} m"
        known = self.precondition(self._person.run_up.skill_for(obstacle))
        if known is None or known.covers(obstacle.size):
            return f"its odds of clearing {what} are {100.0 * odds:.0f} %"
        low, high = known.heights
        return f"{what} is beyond the {size * low:.2f} to {size * high:.2f} m that it has learned"

    def choose_take_off(self, least: float) -> None:
        """Just after a step of a run-up has begun: take the best variation of it, or turn away if its odds
        are below ``least``."""
        person, obstacle, odds = self._person, self._person.run_up.ahead, self._odds_of_variations()
        if obstacle is None or odds is None:
            return
        best = int(np.argmax(odds))
        if best > 0 and odds[best] > odds[0] + _BETTER:
            person.run_up.vary(RUN_UPS[best - 1], person.control, person.run_up.rehearsed)
        if odds[best] < least:
            self._turn_away(obstacle, float(odds[best]))

    def hopeless(self) -> TurnedAway | None:
        """Just after a step of a run-up has begun: what to say of turning away, if no variation of it has
        odds worth rehearsing."""
        person, obstacle, odds = self._person, self._person.run_up.ahead, self._odds_of_variations()
        if obstacle is None or odds is None or odds.max() >= HOPELESS:
            return None
        best = float(odds.max())
        return TurnedAway(person.time, person.point, obstacle.affordance, obstacle.size, best)

    def _odds_of_variations(self) -> NDArray[np.float64] | None:
        """(1 + k,) odds if the step of a run-up that has just begun is made as planned, and with each of
        `RUN_UPS`. None if no such step has begun, or nothing is known of the skill."""
        person, obstacle = self._person, self._person.run_up.ahead
        if obstacle is None or not self._in_run_up or person.control[controller.STEP_TIME] > 0.0:
            return None
        known = self.precondition(person.run_up.skill_for(obstacle))
        if known is None:
            return None
        choices = np.vstack([person.run_up.plan[[FARTHER, FASTER]], RUN_UPS])
        return known.odds(self._described(obstacle, choices)) * known.covers(obstacle.size)

    def _turn_away(self, obstacle: ObstacleAhead, odds: float) -> None:
        """Break the run-up off where that is likelier to hold than going on with these ``odds``."""
        person = self._person
        left = distance_to(obstacle, *person.com[:2])
        slowings = [each for each in BALKINGS if left >= _WAY + _PER_DECELERATION / each + _MARGIN]
        if not slowings:
            return
        holds = self._odds_of_slowing(slowings)
        best = int(np.argmax(holds))
        is_last = left - _STEP < _WAY + _PER_DECELERATION / max(slowings) + _MARGIN
        if holds[best] < _SURE and not (is_last and holds[best] > odds):
            return
        person.events.append(TurnedAway(person.time, person.point, obstacle.affordance, obstacle.size, odds))
        person.balk(slowings[best])

    def _odds_of_slowing(self, slowings: list[float]) -> NDArray[np.float64]:
        """(k,) odds of walking on after having slowed down, for each of ``slowings`` [m/s²]."""
        choices = np.array([(each, 0.0) for each in slowings])
        return self._known[SLOW_DOWN].odds(describe_change(changing(self._person, 0.0, self.grip), choices))
