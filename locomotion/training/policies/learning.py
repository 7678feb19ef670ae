"""Learning of a policy, stage by stage: what is tried, what is learned from it, and what is kept on the
way."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from locomotion.training.policies.agent import Agent, Batch, advantages
from locomotion.training.policies.environment import Outcome
from locomotion.training.progress import Progress
from locomotion.training.search.checkpoint import anew, read_checkpoint
from surefoot.files.archive import write_archive
from surefoot.files.schema import Array, Header, Schema

__all__ = ["LENGTH", "Learning", "PolicyProgress", "show_policy", "tells"]

LENGTH = 24
"""Decisions of each person from one improvement of the policy to the next."""
_KIND, _VERSION = "policy learning", 1


@dataclass(frozen=True)
class PolicyProgress:
    """How learning goes: stage; improvements of the policy so far, and in all in this stage; mean reward;
    share of the decisions after which somebody fell; change of the policy, rate of learning, noise; mean of
    each term of the reward; [s] so far, and to come."""

    stage: str
    iteration: int
    iterations: int
    reward: float
    falls: float
    change: float
    rate: float
    noise: float
    terms: dict[str, float]
    elapsed: float
    remaining: float


def show_policy(p: PolicyProgress) -> None:
    """One line, with all terms of the reward, per twenty improvements."""
    if p.iteration % 20:
        return
    terms = "  ".join(f"{name} {value:.3f}" for name, value in p.terms.items())
    print(
        f"{p.stage}: {p.iteration}/{p.iterations}  reward {p.reward:.3f}  falls {1000 * p.falls:.2f} of 1,000"
        f"  change {p.change:.3f}  rate {p.rate:.1e}  noise {p.noise:.3f}  {p.elapsed / 60:.1f} min done,"
        f" {p.remaining / 60:.1f} left  {terms}",
        file=sys.stderr,
        flush=True,
    )


def tells(on_progress: Callable[[Progress], None]) -> Callable[[PolicyProgress], None]:
    """Tell ``on_progress`` of the learning of a policy as of other trainings."""

    def tell(p: PolicyProgress) -> None:
        on_progress(
            Progress(p.stage, p.iteration, p.iterations, -p.reward, 1.0 - p.falls, p.elapsed, p.remaining)
        )

    return tell


class Stage(Protocol):
    """A part of learning.

    name: what it is about. samples: decisions to learn from. noise: standard deviation of what is tried, at
    the stage's beginning and at its end.
    """

    @property
    def name(self) -> str: ...
    @property
    def samples(self) -> int: ...
    @property
    def noise(self) -> tuple[float, float]: ...


class People(Protocol):
    """Many people at once whom a policy moves: those of `environment.Environment`, or of `groups.Groups`.

    count: people. inputs, actions: numbers observed and decided. kept: whether `arrays` are all that goes on;
    where not, everybody begins anew whenever intermediate results are kept. rng: what everything is drawn
    from.
    """

    count: int
    inputs: int
    actions: int
    kept: bool
    rng: np.random.Generator

    def begin(self, stage: Any) -> None: ...
    def reset(self, who: NDArray[np.bool_]) -> None: ...
    def observe(self) -> NDArray[np.float64]: ...
    def step(self, decided: NDArray[np.floating]) -> Outcome: ...
    def arrays(self) -> dict[str, NDArray[Any]]: ...
    def restore(self, arrays: dict[str, NDArray[Any]]) -> None: ...


class _Header(Header):
    stage: int
    iteration: int
    numbers: dict[str, float]
    rngs: list[dict[str, Any]]


@dataclass
class Learning:
    """Learning of a policy. The same ``seed`` gives the same policy, interrupted or not.

    Attributes:
      people: makes those who try it, in the first stage and from a seed. stages: what is learned, in turn.
      checkpoint: file of intermediate results; None: they are not kept. on_progress: called after each
        improvement of the policy. kept_every: improvements after which they are kept. judges: improvements
        at the beginning in which only the critic learns, for a policy that can do something already.
        discount: what a reward is worth a decision later.
      agent, environment: policy and critic, and the people. stage, iteration: how far it is.
    """

    people: Callable[[int], People]
    stages: Sequence[Stage]
    seed: int = 0
    checkpoint: Path | None = None
    on_progress: Callable[[PolicyProgress], None] = show_policy
    kept_every: int = 40
    judges: int = 0
    discount: float = 0.975
    agent: Agent = field(init=False)
    environment: People = field(init=False)

    def __post_init__(self) -> None:
        seeds = np.random.SeedSequence(self.seed).generate_state(2)
        rng = np.random.default_rng(seeds[0])
        self.environment = self.people(int(seeds[1]))
        self.agent = Agent(self.environment.inputs, self.environment.actions, rng, self.stages[0].noise[0])
        self.stage, self.iteration = 0, 0

    def iterations(self, stage: Stage) -> int:
        """Improvements of the policy in a stage."""
        return max(round(stage.samples / (LENGTH * self.environment.count)), 1)

    def run(self, most: int | None = None) -> Agent:
        """Learn all stages, or at most so many improvements, from where it stopped; gives policy and
        critic."""
        self._recall()
        self._begun, self._done, done = time.monotonic(), 0, 0
        self._ahead = sum(self.iterations(stage) for stage in self.stages[self.stage :]) - self.iteration
        while self.stage < len(self.stages):
            stage = self.stages[self.stage]
            total = self.iterations(stage)
            while self.iteration < total:
                if most is not None and done >= most:
                    self._keep()
                    return self.agent
                self._improve(stage, self.iteration / total)
                self.iteration, done = self.iteration + 1, done + 1
                if self.iteration % self.kept_every == 0:
                    self._keep()
            self._keep()
            self.stage, self.iteration = self.stage + 1, 0
            if self.stage < len(self.stages):
                self.environment.begin(self.stages[self.stage])
        return self.agent

    def _improve(self, stage: Stage, share: float) -> None:
        if not self.environment.kept and self.iteration % self.kept_every == 0:
            self.environment.begin(stage)
        first, last = stage.noise
        self.agent.limit_noise(last, first * (last / first) ** min(share / 0.8, 1.0))
        batch, observed, report = self._try()
        change = self.agent.learn(batch, self.stage > 0 or self.iteration >= self.judges)
        self.agent.count_in(observed)
        elapsed = time.monotonic() - self._begun
        self._done += 1
        remaining = elapsed / self._done * (self._ahead - self._done)
        noise = float(np.exp(self.agent.spread).mean())
        self.on_progress(
            PolicyProgress(
                stage.name, self.iteration + 1, self.iterations(stage), *report[:2], change, self.agent.rate,
                noise, report[2], elapsed, remaining,
            )
        )  # fmt: skip

    def _try(self) -> tuple[Batch, NDArray[np.float64], tuple[float, float, dict[str, float]]]:
        """Decide and go on `LENGTH` times; gives what to learn from, what was observed, and a report."""
        agent, environment = self.agent, self.environment
        shape = (LENGTH, environment.count)
        wide, narrow = (*shape, environment.inputs), (*shape, environment.actions)
        inputs, observed = np.empty(wide, np.float32), np.empty(wide)
        means, decided = np.empty(narrow, np.float32), np.empty(narrow, np.float32)
        likelihood, value = np.empty(shape, np.float32), np.empty((LENGTH + 1, environment.count), np.float32)
        reward, done, falls, terms = np.empty(shape), np.empty(shape, bool), 0, []
        if agent.counted < 1.0:
            agent.count_in(environment.observe())
        for t in range(LENGTH):
            observed[t] = environment.observe()
            inputs[t] = agent.scaled(observed[t])
            means[t], value[t] = agent.decide(inputs[t]), agent.expect(inputs[t])
            decided[t], likelihood[t] = agent.explore(means[t])
            outcome = environment.step(decided[t])
            reward[t] = outcome.reward
            if outcome.over.any():  # their time is over, not their walk
                reward[t] += outcome.over * self.discount * agent.expect(agent.scaled(environment.observe()))
            done[t] = outcome.fell | outcome.over
            falls += int(outcome.fell.sum())
            terms.append(outcome.terms)
            environment.reset(done[t])
        value[LENGTH] = agent.expect(agent.scaled(environment.observe()))
        gained = advantages(reward, value, done, self.discount)
        returns = (gained + value[:-1]).ravel().astype(np.float32)
        gained = (gained - gained.mean()) / (gained.std() + 1e-6)
        seen, meant, chosen = (each.reshape(-1, each.shape[-1]) for each in (inputs, means, decided))
        batch = Batch(seen, meant, chosen, likelihood.ravel(), gained.ravel().astype(np.float32), returns)
        averaged = {name: float(np.mean([each[name] for each in terms])) for name in terms[0]}
        report = (float(reward.mean()), falls / reward.size, averaged)
        return batch, observed.reshape(-1, environment.inputs), report

    def _arrays(self) -> dict[str, NDArray[Any]]:
        return {**self.agent.arrays(), **self.environment.arrays()}

    def _keep(self) -> None:
        if self.checkpoint is None:
            return
        rngs = [_plain(each.bit_generator.state) for each in (self.agent.rng, self.environment.rng)]
        header = {
            "stage": self.stage,
            "iteration": self.iteration,
            "numbers": self.agent.numbers(),
            "rngs": rngs,
        }
        write_archive(self.checkpoint, _KIND, _VERSION, header, self._arrays())

    def _recall(self) -> None:
        if self.checkpoint is None or not self.checkpoint.exists():
            return
        arrays = {name: Array(str(each.dtype), each.shape) for name, each in self._arrays().items()}
        schema = Schema(_KIND, _VERSION, _Header, arrays, anew(self.checkpoint))
        header, found = read_checkpoint(self.checkpoint, schema)
        self.stage, self.iteration = header.stage, header.iteration
        self.environment.begin(self.stages[self.stage])
        self.agent.restore(found, header.numbers)
        self.environment.restore(found)
        for each, state in zip((self.agent.rng, self.environment.rng), header.rngs, strict=True):
            each.bit_generator.state = _numbered(state)


def _plain(state: Any) -> Any:
    """A generator's state for JSON, whose numbers may be too long for it."""
    return {k: _plain(v) for k, v in state.items()} if isinstance(state, dict) else str(state)


def _numbered(state: Any) -> Any:
    """A state from `_plain`."""
    if isinstance(state, dict):
        return {k: _numbered(v) for k, v in state.items()}
    return int(state) if state.isdigit() else state
