"""Rehearse ahead of time, so that no tick has to pay for a whole rehearsal.

What a person decides by rehearsal (`locomotion.rehearsal.trials`) depends only on its state at that moment,
and the simulation is exact. So a double runs ahead, a few ticks in each tick of the person, to the next
decision, and rehearses there. The person then replays the double's ticks (`locomotion.rehearsal.predicted`),
decisions included. A push, or giving way, makes the prediction void.

What was not foreseen in time is either rehearsed on the spot, however long that takes, or the person does
without it: it takes the best variation that held so far, or else the one that is being tried. Only in this
second case do decisions depend on how far the double is; `Lookahead.memory` is what has to be saved of that.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Generator

from locomotion.human.state import HumanState, same
from locomotion.rehearsal.deciding import Outcome, Question, known_answer, tick_unless_asked
from locomotion.rehearsal.predicted import Predicted
from locomotion.rehearsal.trials import Rehearsal, at_once
from locomotion.rehearsal.understudy import Understudy
from surefoot.pausing import pause

__all__ = ["PER_TICK", "Lookahead"]

PER_TICK = 20
"""Most ticks of the double in each of the person's."""
_FAR = 400  # most ticks that the double is ahead
_LOOKS = 10  # ticks of the double between checks whether there is something to predict
_REST = 10  # ticks before the next attempt after a wrong prediction


class Lookahead:
    """What a person knows in advance.

    Attributes:
      waits: whether it rehearses on the spot what it did not foresee.
    """

    def __init__(
        self, person: Understudy, double: Callable[[], Understudy], most: int, waits: bool = True
    ) -> None:
        """``double``: makes a copy of ``person`` on the same ground that does not rehearse. ``most``: most
        choices to rehearse for one decision."""
        self._person, self._make_double, self._most, self.waits = person, double, most, waits
        self._double: Understudy | None = None
        self._task: Generator[None, None, None] | None = None
        self._rehearsal: Rehearsal | None = None  # the double's, in progress
        self._answers: list[tuple[Question, Outcome]] = []
        self._spent: deque[int] = deque()
        """By tick from the person's to the double's: ticks spent until the double came there."""
        self._until = self._last = self._begins = self._total = 0
        # the double's tick; the person's last tick; the tick from which to look ahead, 0 while it does; ticks
        # spent in all
        self._checked = -1  # the person's tick before which it was as predicted
        self._saved: HumanState | None = None  # restored, and its ticks ahead are not yet made again

    def get_ready(self) -> None:
        """Make the double, if there is none."""
        self._double_now()

    # --- after a saved state
    def memory(self, state: HumanState) -> tuple[int, int]:
        """What of it makes a difference to the person, which is in ``state``: ticks spent beyond it, and the
        tick from which it may look ahead. Both 0 for one that waits."""
        if self.waits:
            return 0, 0
        if self._saved is not None:
            if same(self._saved, state):
                return self._saved.foresight
            self.catch_up()  # it has been disturbed since it was restored
        if not self._spent:
            return 0, self._begins
        if not self._person.decider.predicted.holds(state):
            return 0, self._after_disturbance
        return self._total - self._spent[0], self._begins

    def recall(self, state: HumanState) -> None:
        """The person was restored to this state."""
        self._last = self._person.ticks
        self._forget(self._last)
        if not self.waits:
            spent, self._begins = state.foresight
            self._saved = state if spent else None

    def catch_up(self) -> None:
        """Before all else: do again what was known when the person was saved."""
        saved = self._saved
        if saved is None:
            return
        spent, begins = saved.foresight
        self._begin(saved)
        for _ in range(spent):
            if self._task is not None:
                next(self._task, None)
                pause()
        if begins and self._task is not None:
            next(self._task, None)  # it was through

    # --- tick by tick
    @property
    def _after_disturbance(self) -> int:
        """The tick from which to look ahead if the prediction does not hold any more."""
        now = self._person.ticks
        return now + 1 + (_REST if self._until > now else 0)

    def foresees(self) -> int | None:
        """Before a tick of the person: `ahead`, after what has happened to it since the last one."""
        self.catch_up()
        if self._spent:
            person = self._person
            if person.decider.predicted.holds(person.save_state()):
                self._checked = person.ticks
            else:
                self._forget(self._after_disturbance)
        return self.ahead

    @property
    def is_as_predicted(self) -> bool:
        """Whether the person was as predicted when `foresees` was asked, before its next tick."""
        return self._checked == self._person.ticks

    def be_surprised(self) -> None:
        """Before a tick of the person that was not predicted."""
        if self._until > self._person.ticks:
            self._forget(self._after_disturbance)

    def look_back(self) -> None:
        """After each tick of the person: forget what no longer holds."""
        now = self._person.ticks
        if now != self._last + 1:
            self._forget(now)  # it was put somewhere else
        elif self._spent:
            self._spent.popleft()
            behind = now > self._until or (now == self._until and self._rehearsal is None)
            if behind and self._task is not None and not self.waits:
                self._forget(now)
        self._last = now
        self._answers[:] = [answer for answer in self._answers if answer[0].state.ticks >= now]

    @property
    def needs(self) -> int:
        """Ticks that it takes at least until what the double rehearses is answered; 0 if it rehearses
        nothing."""
        return 0 if self._rehearsal is None else self._rehearsal.needs

    @property
    def ahead(self) -> int | None:
        """Ticks that the double is ahead, if it has something to do; else None."""
        now = self._person.ticks
        if self._task is None:
            begins = now >= max(self._until, self._begins) and self._person.decides_soon
            return 0 if begins else None
        ahead = self._until - now
        return ahead if self._rehearsal is not None or ahead < _FAR else None

    def go_on(self, ticks: int) -> int:
        """Advance the double by up to so many ticks and add the new ones to the prediction. Returns how many
        it took."""
        taken = 0
        while taken < ticks and self.ahead is not None:
            if self._task is None:
                self._begin(self._person.save_state())
            assert self._task is not None
            before = self._total
            next(self._task, None)
            taken += self._total - before
        return taken

    def decide(self, question: Question) -> Outcome:
        """The best choice and how well it does."""
        rehearsal = self._rehearsal
        asked = rehearsal is not None and question.is_also(rehearsal.question)
        if self.waits and asked:
            while self._rehearsal is rehearsal and self._task is not None:
                next(self._task, None)
                pause()
        known = known_answer(question, self._answers)
        if known is not None:
            return known
        self._forget(self._person.ticks)
        if self.waits:
            return at_once(Rehearsal(question, self._most).run(self._double_now()))
        if asked and rehearsal is not None:
            return rehearsal.so_far
        return Outcome(question.choices[0], 1.0, [], known=False)

    def _begin(self, state: HumanState) -> None:
        double, future = self._double_now(), self._person.decider.predicted
        self._forget(0)
        self._until = state.ticks
        self._spent.append(self._total)
        future.begin(self._person.model, state)
        self._task = self._go_ahead(state, double, future)

    def _go_ahead(
        self, state: HumanState, double: Understudy, future: Predicted
    ) -> Generator[None, None, None]:
        """Advance the double from ``state`` and rehearse each decision on its way. Each step takes one tick,
        also where the ticks are known already: so it takes as many steps from any state on the way."""
        double.restore_state(state)
        while double.ticks % _LOOKS or double.decides_soon:
            double.events.clear()
            states = _through_known(double)
            question = None if states else tick_unless_asked(double, self._answers)
            while question is not None:
                self._rehearsal = rehearsal = Rehearsal(question, self._most)
                for _ in rehearsal.run(double):
                    self._total += 1
                    rehearsal.tried_for += 1
                    yield
                self._answers.append((question, rehearsal.outcome))
                self._rehearsal = None
                double.restore_state(state)
                double.events.clear()
                question = tick_unless_asked(double, self._answers)
            if double.status == "fallen":
                break  # the person may get up
            for state in states or [double.save_state()]:
                self._total += 1
                self._until = state.ticks
                self._spent.append(self._total)
                future.add(state)
                yield
        for state in double.decider.predicted.all_come_true(double):
            future.add(state)  # costs nothing
        self._task, self._begins = None, self._until + 1

    def _double_now(self) -> Understudy:
        if self._double is None or self._double.model is not self._person.model:
            self._forget(self._person.ticks)
            self._double = self._make_double()
        return self._double

    def _forget(self, begins: int) -> None:
        """Start over at tick ``begins`` or later."""
        if self._task is not None:
            self._task.close()
        self._task, self._rehearsal, self._checked = None, None, -1
        self._answers.clear()
        self._spent.clear()
        self._saved = None
        self._until, self._begins = 0, begins


def _through_known(double: Understudy) -> list[HumanState]:
    """Advance the double through the ticks that it knows, up to one in which there is nothing to decide soon;
    return their states."""
    known = double.decider.predicted.all_come_true(double)
    for count, state in enumerate(known, 1):
        if state.ticks % _LOOKS == 0:
            double.become(state)
            if not double.decides_soon:
                double.decider.predicted.expect(double, known[count:])
                return known[:count]
    if known:
        double.become(known[-1])
    return known
