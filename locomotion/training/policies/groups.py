"""People who learn, in groups that several processes move."""

from __future__ import annotations

import multiprocessing
import os
import signal
from collections.abc import Callable
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from locomotion.training.policies.environment import Outcome

__all__ = ["Group", "Groups"]

_ONE_CORE = {"OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1"}  # for each process


class Group(Protocol):
    """Some of the people, as of `learning.People`. After `begin` with the same ``seed`` they do the same
    again."""

    count: int
    inputs: int
    actions: int

    def begin(self, stage: Any, seed: int) -> None: ...
    def reset(self, who: NDArray[np.bool_]) -> None: ...
    def observe(self) -> NDArray[np.float64]: ...
    def step(self, decided: NDArray[np.floating]) -> Outcome: ...


class Groups:
    """The people of several groups, as `learning.People`; the number of processes changes nothing of what
    they do.

    Attributes:
      count, inputs, actions, rng: as of `learning.People`.
    """

    kept = False

    def __init__(
        self, make: Callable[[int], Group], groups: int, processes: int, stage: Any, seed: int
    ) -> None:
        """``make``: makes the group of a number below ``groups``; other processes can import it.
        ``processes``: 1 is this one."""
        self.rng = np.random.default_rng(seed)
        processes = min(processes, groups)
        self._numbers = [list(range(first, groups, processes)) for first in range(processes)]
        self._workers: list[_Here] | list[_Process]
        if processes == 1:
            self._workers = [_Here(make, self._numbers[0])]
        else:
            self._workers = [_Process(make, numbers) for numbers in self._numbers]
        sizes = [size for worker in self._workers for size in worker.answers()]
        self._places = np.argsort(np.concatenate(self._numbers))
        self._counts = [sizes[k][0] for k in self._places]
        self.count, (_, self.inputs, self.actions) = sum(self._counts), sizes[0]
        self.begin(stage)

    def begin(self, stage: Any) -> None:
        """Everybody begins anew, in another stage."""
        seeds = self.rng.integers(0, 2**31, len(self._counts)).tolist()
        self._seen = np.concatenate(self._ask([("begin", stage, seed) for seed in seeds]))

    def reset(self, who: NDArray[np.bool_]) -> None:
        """Who fell, and whose time is over, has begun anew already."""
        self._seen = self._anew

    def observe(self) -> NDArray[np.float64]:
        """What the policies observe, (n, inputs)."""
        return self._seen

    def step(self, decided: NDArray[np.floating]) -> Outcome:
        """Do what the policies ``decided`` (n, actions) until the next decision."""
        parts = np.split(decided, np.cumsum(self._counts)[:-1])
        outcomes, seen, anew = zip(*self._ask([("step", part) for part in parts]), strict=True)
        self._seen, self._anew = np.concatenate(seen), np.concatenate(anew)
        shares = np.array(self._counts) / self.count
        terms = {name: float(shares @ [each.terms[name] for each in outcomes]) for name in outcomes[0].terms}
        names = ("reward", "fell", "over", "changes", "switched")
        joined = {name: np.concatenate([getattr(each, name) for each in outcomes]) for name in names}
        return Outcome(**joined, terms=terms)

    def arrays(self) -> dict[str, NDArray[Any]]:
        """Nothing: everybody begins anew."""
        return {}

    def restore(self, arrays: dict[str, NDArray[Any]]) -> None:
        """Nothing to restore."""

    def end(self) -> None:
        """End the processes."""
        for worker in self._workers:
            worker.end()

    def _ask(self, questions: list[tuple[Any, ...]]) -> list[Any]:
        """Answers of all groups, in order."""
        for worker, numbers in zip(self._workers, self._numbers, strict=True):
            worker.ask([questions[k] for k in numbers])
        found = [answer for worker in self._workers for answer in worker.answers()]
        return [found[k] for k in self._places]


class _Here:
    """Groups in this process."""

    def __init__(self, make: Callable[[int], Group], numbers: list[int]) -> None:
        self._groups = [make(number) for number in numbers]
        self._answers: list[Any] = [_sizes(group) for group in self._groups]

    def ask(self, questions: list[tuple[Any, ...]]) -> None:
        self._answers = [_answer(*each) for each in zip(self._groups, questions, strict=True)]

    def answers(self) -> list[Any]:
        return self._answers

    def end(self) -> None:
        self._groups.clear()


class _Process:
    """Groups in a process of their own, which computes on one core."""

    def __init__(self, make: Callable[[int], Group], numbers: list[int]) -> None:
        context = multiprocessing.get_context("spawn")
        self._pipe, there = context.Pipe()
        self._process = context.Process(target=_work, args=(there, make, numbers), daemon=True)
        before = {name: os.environ.get(name) for name in _ONE_CORE}
        os.environ.update(_ONE_CORE)
        try:
            self._process.start()
        finally:
            for name, value in before.items():
                os.environ.pop(name) if value is None else os.environ.update({name: value})
        there.close()

    def ask(self, questions: list[tuple[Any, ...]]) -> None:
        self._pipe.send(questions)

    def answers(self) -> list[Any]:
        return self._pipe.recv()

    def end(self) -> None:
        self._pipe.send(None)
        self._process.join()


def _work(pipe: Any, make: Callable[[int], Group], numbers: list[int]) -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the process that began this one ends it
    here = _Here(make, numbers)
    pipe.send(here.answers())
    while (questions := pipe.recv()) is not None:
        here.ask(questions)
        pipe.send(here.answers())


def _sizes(group: Group) -> tuple[int, int, int]:
    return group.count, group.inputs, group.actions


def _answer(group: Group, question: tuple[Any, ...]) -> Any:
    """What a group observes after it began; or what came of a decision, and what it observes before and after
    some have begun anew."""
    what, *rest = question
    if what == "begin":
        group.begin(*rest)
        return group.observe()
    outcome = group.step(*rest)
    seen, done = group.observe(), outcome.fell | outcome.over
    if not done.any():
        return outcome, seen, seen
    group.reset(done)
    return outcome, seen, group.observe()
