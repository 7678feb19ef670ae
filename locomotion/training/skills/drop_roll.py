"""Training of the drop-roll: one law for all heights, feed-forward first, then feedback, then hard cases."""

import math
import os
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from locomotion.body.learned_file import learned_numbers
from locomotion.gaits.run.skill import RunSkill, load_run_skill
from locomotion.skills.drop_roll import kernel as drop_roll
from locomotion.skills.drop_roll.kernel import ACTIONS, BINS, KNOTS, SENSORS
from locomotion.skills.drop_roll.skill import DROP_ROLL_SKILL, KIND, DropRoll, drop_roll_clip, tables_of
from locomotion.skills.jump.skill import run_digest
from locomotion.skills.skill_file import SkillFamily
from locomotion.training.progress import Clock
from locomotion.training.search.least_squares import Work, fit
from locomotion.training.search.loop import Stage, simulated
from locomotion.training.skills.drop_trial import DropOutcome, DropSimulator
from locomotion.training.skills.jump_trial import JumpSimulator, StartState
from locomotion.training.training import Training

__all__ = ["HEIGHTS", "DropProblem", "cost", "first_guess", "harvest", "scales", "train_drop_roll"]

HEIGHTS = (0.9, 2.0)
"""Least and greatest height [m]; one set of parameters serves all in between."""
_ENTRY = 3.2  # [m/s]
_STATES = 48
_ROLLS, _BALANCING = 24, 4  # trials and rounds of least squares on how the roll ends
_REFINEMENTS = 2  # stages in which half of the trials are those that went worst before
_REFINED = 3  # number of the first of them
_PULL = 0.01
_ROUNDS, _HARD = 2, 0.2  # trials per start state to find the hard ones; share of them that is hard
_TRAINING = "drop-roll training"
_ERROR = 0.1  # [m] by which the distance misses the mark at most
_LONGEST = 3.2  # [s] of a trial up to the roll's end
_HEAD = 0.03  # [m] of the head above the ground in a roll
_EXIT = 2.45  # [m/s] at the roll's end, from which it comes up best
_ANGLE = 5.6  # [rad] turned when the feet are down again
_SIDEWAYS, _SIDE_KNOTS = ("hip_split", "trunk_roll", "trunk_yaw", "legs_side"), slice(1, 6)
_FORWARD, _KNOTS = ("hips", "knees", "trunk_pitch"), slice(2, 5)
_ASLANT = ("tilt", "tilt_rate", "yaw", "yaw_rate", "vy", "aside")  # of the sensors
_SPREAD = np.array([3.0, 0.5, 0.7, 0.08, 0.12, 0.08, 0.25, 2.0, 0.3, 2.0, 0.4, 0.12])  # of the sensors


def first_guess() -> np.ndarray:
    """Parameters (p,) from which learning starts: the clip alone, which rolls."""
    x = np.zeros(sum(drop_roll.PARAMETERS.values()))
    part = drop_roll.parameter_slices()
    x[part["landing"]] = [0.30, 0.05, 0.0, 0.15, 0.0, 0.0, 0.2]
    x[part["timing"]] = [0.05, 0.1, 0.06, 0.12]
    x[part["rise"]] = [5.2, 0.3, -0.02]
    x[part["mark"]] = [0.25, _ENTRY]
    m_ap = np.zeros((len(ACTIONS), drop_roll.RANK))
    m_ap[0, 0] = m_ap[6, 1] = m_ap[7, 2] = 1.0
    x[part["m_ap"]] = m_ap.ravel()
    return x


def scales(feedback: bool) -> np.ndarray:
    """How far a parameter may reasonably move, (p,) float64; without ``feedback`` its parameters stay."""
    x = np.zeros(sum(drop_roll.PARAMETERS.values()))
    part = drop_roll.parameter_slices()
    x[part["pose"]] = np.tile([0.4, 0.4, 0.3, 0.25, 0.4, 0.15, 0.12, 0.12, 0.12], KNOTS)
    x[part["landing"]] = [0.15, 0.1, 0.1, 0.2, 0.1, 0.3, 0.2]
    x[part["timing"]] = [0.05, 0.1, 0.05, 0.05]
    x[part["rise"]] = [0.25, 0.06, 0.06]
    x[part["mark"]] = [0.08, 0.15]
    if feedback:
        x[part["m_sp"]] = np.tile(0.1 / _SPREAD, 3 * drop_roll.RANK)
        x[part["m_ap"]] = 0.4
    return x


def roll_scales() -> np.ndarray:
    """The same for what decides how a roll ends, (p,): the pose about the landing, and the feedback of the
    fall and of the roll on what is aslant."""
    every, x, part = scales(True), np.zeros(sum(drop_roll.PARAMETERS.values())), drop_roll.parameter_slices()
    x[part["landing"]] = every[part["landing"]]
    pose = every[part["pose"]].reshape(KNOTS, len(ACTIONS)).copy()
    for name in ACTIONS:
        knots = _SIDE_KNOTS if name in _SIDEWAYS else _KNOTS if name in _FORWARD else slice(0)
        x[part["pose"]].reshape(pose.shape)[knots, ACTIONS.index(name)] = pose[knots, ACTIONS.index(name)]
    shape = (3, drop_roll.RANK, len(SENSORS))
    m_sp = every[part["m_sp"]].reshape(shape)
    sensed = [SENSORS.index(name) for name in _ASLANT]
    x[part["m_sp"]].reshape(shape)[:2, :, sensed] = m_sp[:2][:, :, sensed]
    return x


def cost(o: DropOutcome) -> float:
    """Objective of one trial."""
    total = 0.0
    if o.angle < _ANGLE or not o.rose:
        total += 6.0 + 6.0 * (1.0 - min(o.angle / _ANGLE, 1.0))
    else:
        total += 4.0 * (1.0 - o.time) + 2.0 * (1.0 - min(max(o.upright, 0.0), 1.0))
        total += (0.0 if o.rolled else 2.0) + 0.05 * min(o.lurch, 60.0)
    return (
        total
        + 0.6 * min(abs(o.drift), 1.5)
        + 0.15 * min(math.hypot(o.momentum[0], o.momentum[2]), 8.0)
        + 0.5 * min(abs(o.exit - _EXIT), 1.5)
        + 0.03 * o.reaction
        + 0.15 * max(o.peak - 5.0, 0.0)
        + 0.4 * (o.head > 0)
        + 0.3 * min(o.head, 16)
        + 0.08 * min(o.tilt, 30.0)
        + 0.8 * min(o.aside, 2.0)
    )


@dataclass
class DropProblem:
    """A range of heights: what `learn` needs.

    initial: (p,) where learning starts. reference: (11, 12) expected sensors. heights: least and greatest
    [m]. hard: trials of which half of those of a generation are drawn.
    """

    run: RunSkill
    heights: tuple[float, float]
    initial: np.ndarray
    reference: np.ndarray
    states: list[StartState]
    curriculum: Sequence[Stage]
    hard: Sequence[tuple[int, float, float]] = ()
    _simulator: DropSimulator | None = None

    def stages(self) -> Sequence[Stage]:
        """The curriculum."""
        return self.curriculum

    def start(self) -> np.ndarray:
        """Where learning starts, (p,)."""
        return self.initial

    def scenarios(
        self, stage: Stage, generation: int, rng: np.random.Generator
    ) -> list[tuple[int, float, float]]:
        """Start state, error of the distance [m] and height [m] of each trial of a generation."""
        drawn = self.draw(stage.options["states"], stage.options["error"], rng)
        hard = [self.hard[i] for i in rng.permutation(len(self.hard))[: len(drawn) // 2]]
        return hard + drawn[len(hard) :]

    def draw(self, count: int, error: float, rng: np.random.Generator) -> list[tuple[int, float, float]]:
        """``count`` trials, evenly over the heights; the distance misses the mark by up to ``error`` [m]."""
        chosen = rng.permutation(len(self.states))[:count]
        jitter = error * (2.0 * rng.random(count) - 1.0)
        shares = rng.permutation((np.arange(count) + rng.random(count)) / count)
        low, high = self.heights
        heights = low + (high - low) * shares
        return [
            (int(i), self.states[i].error + float(e), float(h))
            for i, e, h in zip(chosen, jitter, heights, strict=True)
        ]

    def find_hard(self, candidate: np.ndarray, stage: Stage, rng: np.random.Generator) -> None:
        """Remember the trials that go worst with a candidate: half of those of a generation are drawn from
        them."""
        error, duration = stage.options["error"], stage.options["duration"]
        trials = [trial for _ in range(_ROUNDS) for trial in self.draw(len(self.states), error, rng)]
        costs = [cost(self.outcome(candidate, *trial, duration)) for trial in trials]
        self.hard = [trials[i] for i in np.argsort(costs)[-round(_HARD * len(trials)) :]]
        self._simulator = None

    def outcome(
        self, candidate: np.ndarray, state: int, error: float, height: float, duration: float,
        record: np.ndarray | None = None, rise: bool = True,
    ) -> DropOutcome:  # fmt: skip
        """One trial."""
        if self._simulator is None:
            self._simulator = DropSimulator(self.run)
        tables = tables_of(np.ascontiguousarray(candidate), self.reference)
        return self._simulator.trial(
            tables, height, self.states[state], error, duration, record=record, rise=rise
        )

    def evaluate(self, stage: Stage, candidate: np.ndarray, scenarios: list) -> tuple[float, float]:
        """Mean cost with the pull towards the start, and the share that rolled and walked on."""
        total = rolled = 0.0
        for state, error, height in scenarios:
            result = self.outcome(candidate, state, error, height, stage.options["duration"])
            total += cost(result)
            rolled += result.rolled
        free = stage.scale > 0
        away = (candidate[free] - self.initial[free]) / stage.scale[free]
        n = len(scenarios)
        return total / n + _PULL * float(np.mean(away**2)), rolled / n

    def trials(self, rng: np.random.Generator) -> list[tuple[int, float, float]]:
        """Those of a round of least squares: one from every start state."""
        return self.draw(len(self.states), _ERROR, rng)

    def residuals(self, candidate: np.ndarray, trial: tuple[int, float, float]) -> np.ndarray:
        """How the roll's end differs from the wanted one, in units of what the rise can stand."""
        o = self.outcome(candidate, *trial, _LONGEST, rise=False)
        if not o.rose:
            return np.full(6, np.nan)
        around, turning = o.momentum[0], o.momentum[2]
        head = max(_HEAD - o.low, 0.0)
        off = [around, turning, o.drift, o.tilted, o.exit - _EXIT, head]
        return np.array(off) / [2.0, 1.0, 0.5, 0.08, 0.3, 0.02]

    def record(self, candidate: np.ndarray, rng: np.random.Generator) -> np.ndarray:
        """Mean sensors of trials that went well, (11, 12); the present reference where none did."""
        sums = np.zeros((BINS, len(SENSORS) + 1))
        for state in range(len(self.states)):
            one = np.zeros_like(sums)
            height = float(rng.uniform(*self.heights))
            if self.outcome(candidate, state, self.states[state].error, height, 3.6, one).rolled:
                sums += one
        counts = sums[:, -1:]
        return np.where(counts > 0, sums[:, :-1] / np.maximum(counts, 1.0), self.reference)


def family_of(
    x: np.ndarray,
    reference: np.ndarray,
    stride: tuple[float, float, float],
    run: RunSkill,
    meta: dict[str, Any],
) -> SkillFamily:
    """A family with the same parameters (p,) and expected sensors (11, 12) at both ends of `HEIGHTS`."""
    table, references = np.stack([x, x]), np.stack([reference, reference])
    return SkillFamily(KIND, np.array(HEIGHTS), table, references, stride, run_digest(run), meta)


@dataclass(frozen=True)
class _Course:
    """What stays the same over a whole learning run."""

    run: RunSkill
    stride: tuple[float, float, float]
    training: Training
    clock: Clock


def curriculum(training: Training) -> list[Stage]:
    """The stages; least squares on how the roll ends come between the second and the third."""

    def stage(name: str, count: int, sigma: float, feedback: bool, population: int, **options) -> Stage:
        seconds = options["states"] * options["duration"]
        shared = {"error": _ERROR, **options}
        return Stage(name, training.generations(count), sigma, scales(feedback), shared, population, seconds)

    return [
        stage("feed-forward", 50, 0.12, False, 18, states=8, duration=3.0),
        stage("feedback", 40, 0.1, True, 20, states=10, duration=3.2),
        *(stage("refined", 20, 0.06, True, 16, states=8, duration=5.0) for _ in range(_REFINEMENTS)),
    ]


def train_drop_roll(training: Training, out: str | os.PathLike[str] = DROP_ROLL_SKILL) -> SkillFamily:
    """Learn to roll off drops of `HEIGHTS` on the package's run and walk, and write it to ``out``. The
    training's checkpoint is a folder."""
    run, stages = load_run_skill(), curriculum(training)
    few, many, *finer = stages
    rounds = training.generations(_BALANCING)
    training.prepare(
        "drop-roll", out, stages, ("walk", "run", "speed-up"), rounds=rounds, clip=drop_roll_clip().digest
    )
    stride = JumpSimulator(run).fit_stride(_ENTRY, np.random.default_rng([training.seed, 1]))
    clock = Clock(simulated(stages) + rounds * _round_takes())
    course = _Course(run, stride, training, clock)
    x, reference = _learn(course, 0, few, first_guess(), np.zeros((BINS, len(SENSORS))))
    x, reference = _learn(course, 1, many, x, reference)
    x = _learn_to_end(course, 2, rounds, x, reference)
    for number, stage in enumerate(finer, _REFINED):
        x, reference = _learn(course, number, stage, x, reference)
    skill = family_of(x, reference, stride, run, training.made_by("drop-roll"))
    skill.save(out)
    return skill


def _round_takes() -> float:
    """What a round of least squares simulates [s]: two differences of each parameter, on half of the
    trials."""
    return (1.0 + np.count_nonzero(roll_scales())) * _ROLLS * _LONGEST


def _learn(
    course: _Course, number: int, stage: Stage, x: np.ndarray, reference: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Go through a stage; what was done before is read from the checkpoint.

    Start states are harvested from planned run-ups, half of them from standing. The expected sensors are
    recorded anew after a stage without feedback; a refinement looks for trials that go wrong first.
    """
    training = course.training
    kinds = {"x": learned_numbers(len(x)), "reference": learned_numbers(*reference.shape)}
    arrays = training.recall(_TRAINING, number, kinds)
    if arrays is not None:
        course.clock.skip(simulated([stage]))
        return arrays["x"], arrays["reference"]
    rng = np.random.default_rng([training.seed, number])
    states = harvest(course.run, _roll_of(course, x, reference), _STATES, rng)
    problem = DropProblem(course.run, HEIGHTS, x, reference, states, [stage])
    if number >= _REFINED:
        problem.find_hard(x, stage, rng)
    learned = training.learn(problem, number, f"search-{number}", course.clock)
    if not (stage.scale[drop_roll.parameter_slices()["m_sp"]] > 0).any():
        reference = problem.record(learned, rng)
    if number >= _REFINED:
        training.demand_success("drop-roll", problem, learned)
    training.keep(_TRAINING, number, {"x": learned, "reference": reference})
    return learned, reference


def _learn_to_end(
    course: _Course, number: int, rounds: int, x: np.ndarray, reference: np.ndarray
) -> np.ndarray:
    """Least squares on how the roll ends; what was done before is read from the checkpoint."""
    training = course.training
    rng = np.random.default_rng([training.seed, number])
    states = harvest(course.run, _roll_of(course, x, reference), _ROLLS, rng)
    problem = DropProblem(course.run, HEIGHTS, x, reference, states, [])
    return fit(
        problem, x, roll_scales(), rounds, training.seed + number,
        Work(
            training.file(f"search-{number}"), training.workers, training.on_progress, course.clock,
            _round_takes(),
        ),
    )  # fmt: skip


def _roll_of(course: _Course, x: np.ndarray, reference: np.ndarray) -> DropRoll:
    return DropRoll(family_of(x, reference, course.stride, course.run, {}))


def harvest(run: RunSkill, roll: DropRoll, count: int, rng: np.random.Generator) -> list[StartState]:
    """``count`` start states from planned run-ups, half of them from standing."""
    runner, states = JumpSimulator(run), []
    for standing in (False, True):
        states += runner.harvest(roll, rng.uniform(9.5, 30.0, count // 2), rng, standing)
    return states
