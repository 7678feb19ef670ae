"""Training to run from scratch: the problem, its objective over a stage's trials, and the length of steps."""

import os
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any

import numpy as np

from locomotion.gaits.run import controller as c
from locomotion.gaits.run.skill import RUN_SKILL, RunSkill, run_clip
from locomotion.training.gaits.path_trial import PathScenario, draw_path, follow_path
from locomotion.training.gaits.rollout import Scenario, Simulator, stays_up
from locomotion.training.gaits.run_curriculum import BEGINNINGS, beginning, curriculum
from locomotion.training.gaits.run_genes import first_guess, first_state_reference, skill_of
from locomotion.training.gaits.run_trials import TrialKind, cost, draw_scenario
from locomotion.training.progress import Clock
from locomotion.training.search.loop import Stage, simulated
from locomotion.training.training import Training

__all__ = ["RunProblem", "begin", "fit_step_length", "train_run"]

_JUDGED = 20  # trials in a generation that compares beginnings
_STEPS_PER_TICK = 3  # skills trained with longer physics steps work with the product's, and cost less


def train_run(training: Training, out: str | os.PathLike[str] = RUN_SKILL) -> RunSkill:
    """Train running from scratch and write the skill to ``out``."""
    first, then = beginning(training), curriculum(training)
    training.prepare("run", out, [*first, *then], ("walk",), clip=run_clip().digest)
    clock = Clock(BEGINNINGS * simulated(first) + simulated(then))
    problem = RunProblem(then, begin(training, first, clock), first_state_reference())
    genes = training.learn(problem, BEGINNINGS, clock=clock)
    training.demand_success("run", problem, genes)
    skill = skill_of(genes, problem.reference, meta=training.made_by("run"))
    skill = replace(skill, step_length=fit_step_length(skill))
    skill.save(out)
    return skill


def begin(training: Training, stages: Sequence[Stage], clock: Clock, count: int = BEGINNINGS) -> np.ndarray:
    """Genes of the best of ``count`` searches from scratch, each with its own seed, by the mean cost of
    trials of the last stage."""
    problem = RunProblem(tuple(stages), first_guess(), first_state_reference())
    found = [training.learn(problem, k, f"beginning-{k}", clock) for k in range(count)]
    rng, last = np.random.default_rng(training.seed), stages[-1]
    trials = [trial for _ in range(_JUDGED) for trial in problem.scenarios(last, 0, rng)]
    return min(found, key=lambda genes: problem.evaluate(last, genes, trials)[0])


def fit_step_length(skill: RunSkill) -> tuple[float, float]:
    """(a, b) of step length = a * speed + b [m], by least squares over runs of 12 s at five speeds."""
    measured: list[tuple[float, float]] = []

    def note(simulator: Simulator) -> None:
        state = simulator.state
        if state[c.TICKS] > 400 and state[c.STEP_TIME] == 0.0:
            measured.append((float(state[c.STEP_SPEED]), float(state[c.STEP_LENGTH])))

    for speed in np.linspace(*skill.speeds, 5):
        _simulator().run(skill, Scenario(12.0, np.array([[0.0, speed]])), note)
    if len(measured) < 20:
        return skill.step_length
    speeds, lengths = np.array(measured).T
    a, b = np.polyfit(speeds, lengths, 1)
    return float(a), float(b)


@dataclass(frozen=True)
class RunProblem:
    """Learning of the run for `locomotion.training.search.loop.learn`.

    Attributes:
        curriculum: the stages, see `curriculum`.
        genes: first guess, (len(BLOCKS) * SIZE,) float64.
        reference: reference sensors, (b, 12) float64.
    """

    curriculum: tuple[Stage, ...]
    genes: np.ndarray
    reference: np.ndarray

    def stages(self) -> tuple[Stage, ...]:
        """The curriculum."""
        return self.curriculum

    def start(self) -> np.ndarray:
        """The first guess."""
        return self.genes

    def scenarios(self, stage: Stage, generation: int, rng: np.random.Generator) -> list[Any]:
        """Random trials within the stage's options; kinds with ``length`` are paths to follow."""
        base, kinds = stage.options["trial"], stage.options["kinds"]
        drawn: list[Any] = []
        for i in range(stage.options["trials"]):
            kind = kinds[i % len(kinds)]
            drawn.append(
                draw_path(rng, **kind)
                if "length" in kind
                else draw_scenario(rng, TrialKind(**{**base, **kind}))
            )
        return drawn

    def evaluate(self, stage: Stage, candidate: np.ndarray, scenarios: list[Any]) -> tuple[float, float]:
        """Mean cost and mean share of the time survived."""
        skill = skill_of(candidate, self.reference)
        costs, survived = 0.0, 0.0
        for scenario in scenarios:
            if isinstance(scenario, PathScenario):
                trial = follow_path(scenario, skill)
            else:
                trial = _simulator().run(skill, scenario)
            costs += cost(trial, scenario.duration, stage.options["style"], stage.options["soft"])
            costs += stage.options["fall"] * (not stays_up(trial, scenario.duration))
            survived += trial.figures["time"] / scenario.duration
        return costs / len(scenarios), survived / len(scenarios)


@lru_cache(maxsize=1)
def _simulator() -> Simulator:
    """This process's simulator."""
    return Simulator(_STEPS_PER_TICK)
