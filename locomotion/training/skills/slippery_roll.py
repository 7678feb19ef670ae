"""Training to come up out of the drop-roll on slippery ground: the last part of the roll, the moment at which
the walk takes over, and the walk's gains until its steps count."""

import os
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from locomotion.gaits.run.skill import RunSkill, load_run_skill
from locomotion.gaits.walk.layout import LEVEL, gain_limits
from locomotion.gaits.walk.skill import load_walk_skill
from locomotion.skills.drop_roll.kernel import ACTIONS, KNOTS, parameter_slices
from locomotion.skills.drop_roll.skill import DropRoll, load_drop_roll_skill, tables_of
from locomotion.skills.drop_roll.slippery import SLIPPERY_ROLL, SlipperyRoll
from locomotion.training.search.loop import Stage
from locomotion.training.skills.drop_roll import HEIGHTS, cost, harvest
from locomotion.training.skills.drop_trial import DropSimulator
from locomotion.training.skills.jump_trial import StartState
from locomotion.training.training import Training

__all__ = [
    "LEAST_FRICTION", "SlipperyProblem", "curriculum", "first_guess", "learned_places", "slippery_roll_of",
    "train_slippery_roll",
]  # fmt: skip

LEAST_FRICTION = 0.45
"""Coefficient of friction of the most slippery ground."""
_FRICTIONS = (LEAST_FRICTION, LEAST_FRICTION, 0.6)  # of the trials, in turn
_LAST_KNOTS = range(7, KNOTS)
_POSED = {"hips": 0.3, "knees": 0.3, "ankles": 0.3, "trunk_pitch": 0.2, "shoulders": 0.3}
# [rad] by which actions in the last part of the roll may reasonably move
_RISE = (0.25, 0.06, 0.06)  # the same for the roll's "rise"
_WIDE = 0.25  # the same for a gain, per span of its limits
_STATES, _ERROR = 48, 0.1  # start states; [m] by which the distance misses the mark at most
_OUTSIDE = 0.2  # cost per span of a gain outside of its limits


def learned_places() -> np.ndarray:
    """Which of the roll's parameters are learned."""
    part = parameter_slices()
    pose = np.arange(part["pose"].start, part["pose"].stop).reshape(KNOTS, len(ACTIONS))
    posed = pose[np.ix_(_LAST_KNOTS, [ACTIONS.index(name) for name in _POSED])]
    return np.concatenate([np.arange(part["rise"].start, part["rise"].stop), posed.ravel()])


def _usual_roll() -> tuple[np.ndarray, np.ndarray]:
    """Parameters and expected sensors of the package's roll, the same for all heights."""
    return load_drop_roll_skill().at(HEIGHTS[0])


def first_guess() -> np.ndarray:
    """What is learned, (n,), as on usual ground: parameters of the roll, then the walk's gains."""
    return np.concatenate([_usual_roll()[0][learned_places()], load_walk_skill().tables[LEVEL]])


def slippery_roll_of(x: np.ndarray, meta: dict | None = None) -> SlipperyRoll:
    """The skill of these parameters (n,)."""
    roll, free = _usual_roll()[0].copy(), learned_places()
    roll[free] = x[: len(free)]
    gains = np.clip(x[len(free) :], *gain_limits())
    return SlipperyRoll(roll, gains, LEAST_FRICTION, meta or {})


def curriculum(training: Training) -> tuple[Stage, ...]:
    """The stages."""
    low, high = gain_limits()
    scale = np.concatenate([_RISE, np.tile(list(_POSED.values()), len(_LAST_KNOTS)), _WIDE * (high - low)])

    def stage(name: str, generations: int, sigma: float, trials: int, duration: float) -> Stage:
        options, population = {"trials": trials, "duration": duration}, 20
        seconds = trials * duration
        return Stage(name, training.generations(generations), sigma, scale, options, population, seconds)

    return (stage("come up", 30, 0.3, 12, 4.5), stage("go on", 40, 0.18, 18, 5.0))


@dataclass
class SlipperyProblem:
    """Coming up on slippery ground, from start states of run-ups: what `learn` needs. A trial is a start
    state's number, an error of its distance [m], a height [m] and a coefficient of friction."""

    run: RunSkill
    states: list[StartState]
    curriculum: Sequence[Stage]
    _simulator: DropSimulator | None = None

    def stages(self) -> Sequence[Stage]:
        """The curriculum."""
        return self.curriculum

    def start(self) -> np.ndarray:
        """The first guess."""
        return first_guess()

    def scenarios(
        self, stage: Stage, generation: int, rng: np.random.Generator
    ) -> list[tuple[int, float, float, float]]:
        """Trials evenly over the heights, two thirds of them on the most slippery ground."""
        count = stage.options["trials"]
        chosen = rng.integers(len(self.states), size=count)
        errors = rng.uniform(-_ERROR, _ERROR, count)
        heights = np.interp((np.arange(count) + rng.random(count)) / count, (0.0, 1.0), HEIGHTS)
        return [
            (int(i), self.states[i].error + float(error), float(height), _FRICTIONS[k % len(_FRICTIONS)])
            for k, (i, error, height) in enumerate(zip(chosen, errors, heights, strict=True))
        ]

    def evaluate(
        self, stage: Stage, candidate: np.ndarray, scenarios: list[tuple[int, float, float, float]]
    ) -> tuple[float, float]:
        """Mean cost, and the share that rolled and went on."""
        skill = slippery_roll_of(candidate)
        simulator = self._simulator = self._simulator or DropSimulator(self.run)
        usual, reference = _usual_roll()
        total = rolled = 0.0
        for state, error, height, friction in scenarios:
            share = skill.share(friction)
            simulator.become_slippery(friction, skill.walk_tables(simulator.gait, share))
            tables = tables_of(skill.parameters(usual, share), reference)
            outcome = simulator.trial(tables, height, self.states[state], error, stage.options["duration"])
            total += cost(outcome)
            rolled += outcome.rolled
        low, high = gain_limits()
        gains = candidate[-len(low) :]
        outside = np.maximum(gains - high, 0.0) + np.maximum(low - gains, 0.0)
        return (
            total / len(scenarios) + _OUTSIDE * float((outside / (high - low)).sum()),
            rolled / len(scenarios),
        )


def train_slippery_roll(training: Training, out: str | os.PathLike[str] = SLIPPERY_ROLL) -> SlipperyRoll:
    """Learn to come up out of the package's drop-roll on slippery ground, and write it to ``out``."""
    run, stages = load_run_skill(), curriculum(training)
    training.prepare("slippery-roll", out, stages, ("walk", "run", "speed-up", "drop-roll"))
    rng = np.random.default_rng([training.seed, 1])
    problem = SlipperyProblem(run, harvest(run, DropRoll(load_drop_roll_skill()), _STATES, rng), stages)
    learned = training.learn(problem)
    training.demand_success("slippery-roll", problem, learned)
    skill = slippery_roll_of(learned, training.made_by("slippery-roll"))
    skill.save(out)
    return skill
