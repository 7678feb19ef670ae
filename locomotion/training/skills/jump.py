"""Learning to jump: heights by continuation, feed-forward first, then feedback on many start states; beyond
these heights by prediction from the learned ones and correction."""

import os
from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from locomotion.body.learned_file import learned_numbers
from locomotion.errors import LocomotionError
from locomotion.gaits.run.skill import RunSkill, load_run_skill
from locomotion.skills.description import SkillDescription, load_description
from locomotion.skills.interface import skill_ranges
from locomotion.skills.jump import kernel as jump
from locomotion.skills.jump.skill import (
    JUMP_SKILL,
    Jump,
    run_digest,
    tables_of,
)
from locomotion.skills.leap.kind import LEAP_DESCRIPTION
from locomotion.skills.library import learned_skills
from locomotion.skills.skill_file import SkillFamily
from locomotion.training.progress import Clock
from locomotion.training.search.loop import Stage, simulated
from locomotion.training.skills.jump_kind import WEIGHTS, JumpKind, cost, first_guess, scales, stair_jump
from locomotion.training.skills.jump_trial import JumpOutcome, JumpSimulator, LedgeSimulator, StartState
from locomotion.training.training import NotLearnedError, Training
from navmesh.obstacles.kinds import kind_of

__all__ = ["FURTHER", "HEIGHTS", "LOWEST", "JumpProblem", "train_described", "train_jump"]

HEIGHTS = (0.3, 0.4, 0.5)
"""Heights [m] learned one after the other, each from the one before."""
FURTHER = (0.6, 0.7, 0.2, 0.15)
"""Heights [m] learned after these, each predicted from the two learned ones that are nearest to it."""
LOWEST = 0.1
"""[m] down to which the jump onto the least of them serves."""
_STEPPING_STONE = 0.3
# [m]; the law between 0.2 and 0.4 m does better there than what was learned first
_STATES, _FEWEST = 48, 12  # start states that are harvested for a height; at least, with less effort
_SHARES = (0.0, 0.3, 0.6, 1.0)
# of the way that extrapolation over the height suggests: the best of them is where learning starts
_REFERENCE = (jump.STEPS, jump.BINS, jump.SENSORS)
_SECOND_PASS, _FURTHER = 100, 200
_ENTRY = jump.parameter_slices()["entry"].start
_TRAINING = "jump training"


@dataclass
class JumpProblem:
    """One height (gap: width): what `learn` needs.

    initial: (p,) where learning starts, the solution at the neighbouring height; solutions are pulled
    towards it.
    reference: (4, 6, 15) expected sensors. states: harvested from planned run-ups. curriculum: the
    stages; their options are ``states`` (per generation), ``error`` [m] added to the distance,
    ``duration`` [s], ``pull``.
    """

    kind: JumpKind
    run: RunSkill
    height: float
    initial: np.ndarray
    reference: np.ndarray
    states: list[StartState]
    curriculum: Sequence[Stage]
    _simulator: JumpSimulator | None = None

    def stages(self) -> Sequence[Stage]:
        """The curriculum."""
        return self.curriculum

    def start(self) -> np.ndarray:
        """The neighbour's solution, (p,)."""
        return self.initial

    def scenarios(self, stage: Stage, generation: int, rng: np.random.Generator) -> list[tuple[int, float]]:
        """Start states and errors of the distance [m] of one generation, half from either foot."""
        count, error = stage.options["states"], stage.options["error"]
        chosen = rng.permutation(len(self.states))[:count]
        jitter = error * (2.0 * (np.arange(count) + rng.random(count)) / count - 1.0)
        return [(int(i), self.states[i].error + float(e)) for i, e in zip(chosen, jitter, strict=False)]

    def outcome(self, candidate: np.ndarray, state: int, error: float, duration: float) -> JumpOutcome:
        """One trial."""
        if self._simulator is None:
            self._simulator = self.kind.simulator(self.run)
        tables = tables_of(np.ascontiguousarray(candidate), self.reference, self.run, self.kind.clip)
        return self._simulator.trial(tables, self.height, self.states[state], error, duration)

    def evaluate(self, stage: Stage, candidate: np.ndarray, scenarios: list) -> tuple[float, float]:
        """Mean cost with the pull towards the start, and the share cleared."""
        total = cleared = 0.0
        for state, error in scenarios:
            result = self.outcome(candidate, state, error, stage.options["duration"])
            total += cost(result, float(candidate[_ENTRY]), self.kind.weights)
            cleared += result.cleared
        free = stage.scale > 0
        away = (candidate[free] - self.initial[free]) / stage.scale[free]
        return total / len(scenarios) + stage.options["pull"] * float(np.mean(away**2)), cleared / len(
            scenarios
        )

    def predict(self, beyond: np.ndarray) -> None:
        """Start from the best of some steps from ``initial`` towards ``beyond`` (p,)."""
        stage, every = self.curriculum[0], [(i, state.error) for i, state in enumerate(self.states)]
        guesses = [self.initial + share * (beyond - self.initial) for share in _SHARES]
        self.initial = min(guesses, key=lambda guess: self.evaluate(stage, guess, every)[0])
        self._simulator = None

    def record(self, candidate: np.ndarray) -> np.ndarray:
        """Mean sensors of the cleared jumps without errors, (4, 6, 15); the present reference where none
        is."""
        sums = np.zeros((jump.STEPS, jump.BINS, jump.SENSORS + 1))
        simulator = self.kind.simulator(self.run)
        tables = tables_of(np.ascontiguousarray(candidate), self.reference, self.run, self.kind.clip)
        for state in self.states[:16]:
            one = np.zeros_like(sums)
            if simulator.trial(tables, self.height, state, state.error, 2.0, record=one).cleared:
                sums += one
        counts = sums[..., -1:]
        return np.where(counts > 0, sums[..., :-1] / np.maximum(counts, 1.0), self.reference)


@dataclass(frozen=True)
class _Course:
    """What stays the same over a whole learning run."""

    kind: JumpKind
    run: RunSkill
    stride: tuple[float, float, float]
    training: Training
    clock: Clock


def _first_pass(training: Training, height: float) -> list[Stage]:
    """Feed-forward on few start states, then feedback on many."""
    few = {"states": 4, "error": 0.05, "duration": 2.2, "pull": 0.1}
    many = {"states": 8, "error": 0.15, "duration": 3.0, "pull": 0.15}
    return [
        _stage(training, f"{height:g} m, feed-forward", 30, 0.25, False, 16, few),
        _stage(training, f"{height:g} m, feedback", 21, 0.2, True, 20, many),
    ]


def _second_pass(training: Training, height: float) -> list[Stage]:
    """Refinement on more start states, reached from standing, and for longer."""
    most = {"states": 10, "error": 0.1, "duration": 4.0, "pull": 0.15}
    return [_stage(training, f"{height:g} m, refined", 14, 0.1, True, 20, most)]


def _correction(training: Training, height: float) -> list[Stage]:
    """Of what was predicted for a height."""
    several = {"states": 6, "error": 0.1, "duration": 3.0, "pull": 0.1}
    return [_stage(training, f"{height:g} m, corrected", 24, 0.1, True, 16, several)]


def _stage(
    training: Training, name: str, count: int, sigma: float, feedback: bool, population: int, options: dict
) -> Stage:
    seconds = options["states"] * options["duration"]
    return Stage(name, training.generations(count), sigma, scales(feedback), options, population, seconds)


def train_jump(training: Training, out: str | os.PathLike[str] = JUMP_SKILL) -> SkillFamily:
    """Learn jumps from `LOWEST` to the greatest of `FURTHER` on the package's run and write them to ``out``.
    The training's checkpoint is a folder."""
    course = _course(stair_jump(), training, out, HEIGHTS, FURTHER)
    learned = _learn_in_turn(course, HEIGHTS)
    for number, height in enumerate(FURTHER, _FURTHER):
        learned[height] = _learn_further(course, height, number, learned)
    learned[LOWEST] = learned[min(learned)]
    learned.pop(_STEPPING_STONE, None)
    skill = _family(course, learned, training.made_by("jump"))
    skill.save(out)
    return skill


def train_described(
    path: str | os.PathLike[str],
    training: Training,
    out: str | os.PathLike[str] | None = None,
) -> SkillFamily:
    """Learn a skill that is described by a file (`locomotion.skills.description`), size by size, and write it
    to ``out`` (None: where its description says). The training's checkpoint is a folder.

    Raises `LocomotionError` for a bad description, an unknown term of the objective, or a range of sizes that
    does not join that of the package's skills.
    """
    description = load_description(path)
    unknown = sorted(set(description.objective) - set(WEIGHTS))
    if unknown:
        raise LocomotionError(f"{path}: objective: {unknown[0]!r}: valid terms: {', '.join(WEIGHTS)}")
    _check_use(path, description)
    clip, crossing = description.load_clip(), kind_of(description.affordance).crossing
    simulator = (
        partial(JumpSimulator, clip=clip)
        if crossing == "onto"
        else partial(LedgeSimulator, clip=clip, crossing=crossing)
    )
    kind = JumpKind(
        description.kind, description.affordance, clip, simulator, description.entry, description.marks,
        description.pace, description.share, {**WEIGHTS, **description.objective},
    )  # fmt: skip
    out = description.learned if out is None else out
    course = _course(kind, training, out, description.sizes)
    learned = _learn_in_turn(course, description.sizes)
    if description.least is not None:
        learned[description.least] = learned[description.sizes[0]]
    meta = {**training.made_by(Path(path).name), "description": description.content(clip)}
    skill = _family(course, learned, meta)
    skill.save(out)
    return skill


def _check_use(path: str | os.PathLike[str], description: SkillDescription) -> None:
    """Raises `LocomotionError` if the run does not come to what is described, or nobody could have it in
    addition to the package's skills."""
    run, entry = load_run_skill(), description.entry
    low, high = run.speeds
    if not low <= entry <= high:
        raise LocomotionError(f"{path}: entry: {entry:g} m/s: the run goes from {low:g} to {high:g} m/s")
    if Path(path).samefile(LEAP_DESCRIPTION):
        return  # it takes its own place
    try:
        skill_ranges([*learned_skills(run), description])
    except LocomotionError as error:
        raise LocomotionError(f"{path}: sizes: {error}") from None


def _course(
    kind: JumpKind,
    training: Training,
    out: str | os.PathLike[str],
    heights: Sequence[float],
    further: Sequence[float] = (),
) -> _Course:
    """``out``: file for the skill; ``heights``, ``further`` [m]: those that will be learned in turn, and by
    extrapolation."""
    run = load_run_skill()
    passes = [
        *(stage for height in heights for stage in _first_pass(training, height)),
        *(stage for height in heights for stage in _second_pass(training, height)),
        *(stage for height in further for stage in _correction(training, height)),
    ]
    decide = {**kind.decide(), "sizes": [*heights, *further]}
    training.prepare(kind.name, out, passes, ("walk", "run", "speed-up"), **decide)
    stride = kind.simulator(run).fit_stride(kind.entry, np.random.default_rng([training.seed, 1]))
    return _Course(kind, run, stride, training, Clock(simulated(passes)))


def _learn_in_turn(course: _Course, heights: Sequence[float]) -> dict[float, tuple[np.ndarray, np.ndarray]]:
    """Parameters (p,) and expected sensors (4, 6, 15) by height [m], each learned from the one before and
    then refined."""
    learned = {}
    x, reference = first_guess(course.kind), np.zeros(_REFERENCE)
    for number, height in enumerate(heights):
        stages = _first_pass(course.training, height)
        x, reference = _learn_height(course, height, number, stages, x, reference)
        learned[height] = x, reference
    for number, height in enumerate(heights, _SECOND_PASS):
        stages = _second_pass(course.training, height)
        learned[height] = _learn_height(course, height, number, stages, *learned[height])
    return learned


def _learn_further(
    course: _Course, height: float, number: int, learned: dict[float, tuple[np.ndarray, np.ndarray]]
) -> tuple[np.ndarray, np.ndarray]:
    """Predict the parameters at a height from the two learned ones nearest to it, and correct them."""
    near, far = sorted(learned, key=lambda other: abs(other - height))[:2]
    (x, reference), slope = learned[near], (learned[near][0] - learned[far][0]) / (near - far)
    beyond = x + (height - near) * slope
    stages = _correction(course.training, height)
    return _learn_height(course, height, number, stages, x, reference, beyond)


def _family(
    course: _Course, learned: dict[float, tuple[np.ndarray, np.ndarray]], meta: dict[str, Any]
) -> SkillFamily:
    """The family of parameters and expected sensors (4, 6, 15), by height [m]."""
    heights = sorted(learned)
    table = np.array([learned[height][0] for height in heights])
    references = np.array([learned[height][1].reshape(-1, jump.SENSORS) for height in heights])
    return SkillFamily(
        course.kind.name, np.array(heights), table, references, course.stride, run_digest(course.run), meta
    )


def _learn_height(
    course: _Course,
    height: float,
    number: int,
    stages: list[Stage],
    x: np.ndarray,
    reference: np.ndarray,
    beyond: np.ndarray | None = None,
) -> tuple[np.ndarray, np.ndarray]:
    """Go through stages at a height; what was done before is read from the checkpoint.

    The expected sensors are recorded anew after a stage of feed-forward. ``beyond``: (p,) where extrapolation
    suggests the solution.
    """
    training = course.training
    kinds = {"x": learned_numbers(len(x)), "reference": learned_numbers(*reference.shape)}
    arrays = training.recall(_TRAINING, number, kinds)
    if arrays is not None:
        course.clock.skip(simulated(stages))
        return arrays["x"], arrays["reference"]
    rng = np.random.default_rng([training.seed, number])
    guess = _family(course, {height: (x, reference)}, {})
    standing = number >= _SECOND_PASS
    count = max(round(_STATES * min(training.effort, 1.0)), _FEWEST)
    distances = rng.uniform(*((9.5, 30.0) if standing else (8.0, 16.0)), count)
    skill = Jump(guess, course.run, course.kind.affordance, course.kind.clip)
    states = course.kind.simulator(course.run).harvest(skill, distances, rng, standing)
    if not states:
        raise NotLearnedError(
            f"{course.kind.name}: no run-up to {height:g} m comes to where the last step begins; begin with "
            "another entry speed or other marks"
        )
    for place, stage in enumerate(stages):
        problem = JumpProblem(course.kind, course.run, height, x, reference, states, [stage])
        if beyond is not None:
            problem.predict(beyond)
        x = training.learn(problem, 1000 * number + place, f"search-{number}-{place}", course.clock)
        if not (stage.scale[jump.parameter_slices()["m_sp"]] > 0).any():
            reference = problem.record(x)
        if place == len(stages) - 1:
            training.demand_success(course.kind.name, problem, x)
    training.keep(_TRAINING, number, {"x": x, "reference": reference})
    return x, reference
