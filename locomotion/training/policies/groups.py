"""People who learn, in groups that several processes move."""

from __future__ import annotations

import multiprocessing
import os
from collections.abc import Callable
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from locomotion.errors import LocomotionError
from locomotion.training.policies.environment import Outcome
from surefoot.errors import SurefootError
from surefoot.workers.pool import spared_ctrl_c

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
        ``processes``: 1 is this one. Raises `LocomotionError` if one of them ends by itself; so do `begin`
        and `step`."""
        self.rng = np.random.default_rng(seed)
        processes = min(processes, groups)
        self._numbers = [list(range(first, groups, processes)) for first in range(processes)]
        self._workers: list[_Here] | list[_Process]
        if processes == 1:
            self._workers = [_Here(make, self._numbers[0])]
        else:
            self._workers = [_Process(make, numbers) for numbers in self._numbers]
        self._places = np.argsort(np.concatenate(self._numbers))
        try:
            sizes = self._answers()
            self._counts = [count for count, _, _ in sizes]
            self.count, (_, self.inputs, self.actions) = sum(self._counts), sizes[0]
            self.begin(stage)
        except BaseException:
            self.end()
            raise

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
        return self._answers()

    def _answers(self) -> list[Any]:
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
            with spared_ctrl_c():
                self._process.start()
        finally:
            for name, value in before.items():
                os.environ.pop(name) if value is None else os.environ.update({name: value})
        there.close()

    def ask(self, questions: list[tuple[Any, ...]]) -> None:
        try:
            self._pipe.send(questions)
        except OSError:
            raise self._has_ended() from None

    def answers(self) -> list[Any]:
        try:
            answers = self._pipe.recv()
        except (EOFError, OSError):
            raise self._has_ended() from None
        if isinstance(answers, SurefootError):
            raise answers
        return answers

    def end(self) -> None:
        self._process.terminate()  # it may be sending an answer that nobody reads
        self._process.join()
        self._pipe.close()

    def _has_ended(self) -> LocomotionError:
        self._process.join()
        code = self._process.exitcode
        return LocomotionError(
            f"a process of the training has ended by itself (exit code {code}); if it was killed because "
            "memory ran out, use fewer workers; the same command goes on from the checkpoint"
        )


def _work(pipe: Any, make: Callable[[int], Group], numbers: list[int]) -> None:
    try:
        here = _Here(make, numbers)
        pipe.send(here.answers())
        while True:
            try:
                questions = pipe.recv()
            except EOFError:
                return  # the process that began this one is gone
            here.ask(questions)
            pipe.send(here.answers())
    except SurefootError as error:
        pipe.send(error)


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
