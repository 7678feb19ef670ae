"""Learning to jump: heights by continuation, feed-forward first, then feedback on many start states; beyond
these heights by prediction from the learned ones and correction."""

import os
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from locomotion import jump
from locomotion.errors import LocomotionError
from locomotion.jump_skill import (
    JUMP_SKILL,
    Jump,
    load_jump_skill,
    run_digest,
    tables_of,
)
from locomotion.skill import RunSkill, load_run_skill
from locomotion.skill_description import load_description
from locomotion.skill_family import SkillFamily
from locomotion.training.jump_kind import WEIGHTS, JumpKind, cost, first_guess, scales, stair_jump
from locomotion.training.jump_trial import JumpOutcome, JumpSimulator, LedgeSimulator, StartState
from locomotion.training.loop import Progress, Stage, learn
from navmesh.archive import read_archive, write_archive

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
_TRAINING, _VERSION = "jump training", 1


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
    seed: int
    folder: Path | None
    workers: int
    effort: float
    on_progress: Callable[[Progress], None] | None

    def generations(self, n: int) -> int:
        return max(round(n * self.effort), 1)

    def first_pass(self, height: float) -> list[Stage]:
        """Feed-forward on few start states, then feedback on many."""
        few = {"states": 4, "error": 0.05, "duration": 2.2, "pull": 0.1}
        many = {"states": 8, "error": 0.15, "duration": 3.0, "pull": 0.15}
        return [
            Stage(f"{height:g} m, feed-forward", self.generations(30), 0.25, scales(False), few, 16),
            Stage(f"{height:g} m, feedback", self.generations(21), 0.2, scales(True), many, 20),
        ]

    def second_pass(self, height: float) -> list[Stage]:
        """Refinement on more start states, reached from standing, and for longer."""
        most = {"states": 10, "error": 0.1, "duration": 4.0, "pull": 0.15}
        return [Stage(f"{height:g} m, refined", self.generations(14), 0.1, scales(True), most, 20)]

    def correction(self, height: float) -> list[Stage]:
        """Of what was predicted for a height."""
        several = {"states": 6, "error": 0.1, "duration": 3.0, "pull": 0.1}
        return [Stage(f"{height:g} m, corrected", self.generations(24), 0.1, scales(True), several, 16)]


def train_jump(
    out: str | os.PathLike[str] = JUMP_SKILL,
    seed: int = 0,
    checkpoint: str | os.PathLike[str] | None = None,
    workers: int = 2,
    effort: float = 1.0,
    start_from: str | os.PathLike[str] | None = None,
    on_progress: Callable[[Progress], None] | None = None,
) -> SkillFamily:
    """Learn jumps from `LOWEST` to the greatest of `FURTHER` on the package's run and write them to ``out``.

    ``checkpoint``: folder for the state of learning; a run that was interrupted goes on from it and gives
    the same result. ``effort``: scales the number of generations, and below 1 that of start states.
    ``start_from``: a jump skill to refine (after the run has changed) instead of beginning from nothing; of
    `FURTHER` only what it has not is learned. The same seed gives the same skill with any number of workers.
    """
    course = _course(stair_jump(), seed, checkpoint, workers, effort, on_progress)
    learned: dict[float, tuple[np.ndarray, np.ndarray]] = {}
    if start_from is None:
        learned |= _learn_in_turn(course, HEIGHTS)
    else:
        old = load_jump_skill(start_from)
        for height, x, reference in zip(old.heights, old.table, old.references, strict=True):
            learned[round(float(height), 3)] = x, reference.reshape(_REFERENCE)
    for number, height in enumerate(tuple(learned), _SECOND_PASS):
        stages = course.second_pass(height)
        learned[height] = _learn_height(course, height, number, stages, *learned[height])
    for number, height in enumerate(FURTHER, _FURTHER):
        if height not in learned:
            learned[height] = _learn_further(course, height, number, learned)
    learned[LOWEST] = learned[min(learned)]
    learned.pop(_STEPPING_STONE, None)
    skill = _family(course, learned, {"made by": "surefoot train jump", "seed": seed, "effort": effort})
    skill.save(out)
    return skill


def train_described(
    path: str | os.PathLike[str],
    out: str | os.PathLike[str] | None = None,
    seed: int = 0,
    checkpoint: str | os.PathLike[str] | None = None,
    workers: int = 2,
    effort: float = 1.0,
    on_progress: Callable[[Progress], None] | None = None,
) -> SkillFamily:
    """Learn a skill that is described by a file (`locomotion.skill_description`), size by size, and write it
    to ``out`` (None: where its description says); the others as of `train_jump`.

    Raises `LocomotionError` for a bad description or an unknown term of the objective.
    """
    description = load_description(path)
    unknown = sorted(set(description.objective) - set(WEIGHTS))
    if unknown:
        raise LocomotionError(f"{path}: objective: {unknown[0]!r}: valid terms: {', '.join(WEIGHTS)}")
    clip = description.load_clip()
    simulator = (
        partial(JumpSimulator, clip=clip)
        if description.affordance == "jump"
        else partial(LedgeSimulator, clip=clip, affordance=description.affordance)
    )
    kind = JumpKind(
        description.kind, description.affordance, clip, simulator, description.entry, description.marks,
        description.pace, description.share, {**WEIGHTS, **description.objective},
    )  # fmt: skip
    course = _course(kind, seed, checkpoint, workers, effort, on_progress)
    learned = _learn_in_turn(course, description.sizes)
    for number, (size, solution) in enumerate(learned.items(), _SECOND_PASS):
        learned[size] = _learn_height(course, size, number, course.second_pass(size), *solution)
    if description.least is not None:
        learned[description.least] = learned[description.sizes[0]]
    meta = {"made by": f"surefoot train {Path(path).name}", "seed": seed, "effort": effort}
    skill = _family(course, learned, meta)
    skill.save(description.learned if out is None else out)
    return skill


def _course(
    kind: JumpKind,
    seed: int,
    checkpoint: str | os.PathLike[str] | None,
    workers: int,
    effort: float,
    on_progress: Callable[[Progress], None] | None,
) -> _Course:
    run = load_run_skill()
    folder = Path(checkpoint) if checkpoint is not None else None
    if folder is not None:
        folder.mkdir(parents=True, exist_ok=True)
    stride = kind.simulator(run).fit_stride(kind.entry, np.random.default_rng([seed, 1]))
    return _Course(kind, run, stride, seed, folder, workers, effort, on_progress)


def _learn_in_turn(course: _Course, heights: Sequence[float]) -> dict[float, tuple[np.ndarray, np.ndarray]]:
    """Parameters (p,) and expected sensors (4, 6, 15) by height [m], each learned from the one before."""
    learned = {}
    x, reference = first_guess(course.kind), np.zeros(_REFERENCE)
    for number, height in enumerate(heights):
        x, reference = _learn_height(course, height, number, course.first_pass(height), x, reference)
        learned[height] = x, reference
    return learned


def _learn_further(
    course: _Course, height: float, number: int, learned: dict[float, tuple[np.ndarray, np.ndarray]]
) -> tuple[np.ndarray, np.ndarray]:
    """Predict the parameters at a height from the two learned ones nearest to it, and correct them."""
    near, far = sorted(learned, key=lambda other: abs(other - height))[:2]
    (x, reference), slope = learned[near], (learned[near][0] - learned[far][0]) / (near - far)
    beyond = x + (height - near) * slope
    return _learn_height(course, height, number, course.correction(height), x, reference, beyond)


def _family(
    course: _Course, learned: dict[float, tuple[np.ndarray, np.ndarray]], meta: dict[str, Any]
) -> SkillFamily:
    """The family of parameters and expected sensors (4, 6, 15), by height [m]."""
    heights = sorted(learned)
    table = np.array([learned[height][0] for height in heights])
    references = np.array([learned[height][1].reshape(-1, jump.SENSORS) for height in heights])
    digest = run_digest(course.run)
    return SkillFamily(course.kind.name, np.array(heights), table, references, course.stride, digest, meta)


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
    identity = {"seed": course.seed, "run": run_digest(course.run), "effort": course.effort}
    done = None if course.folder is None else course.folder / f"done-{number}.npz"
    if done is not None and done.exists():
        header, arrays = read_archive(done, _TRAINING, _VERSION)
        if {key: header.get(key) for key in identity} != identity:
            raise LocomotionError(f"{done}: checkpoint of another training or seed; remove it to begin anew")
        return arrays["x"], arrays["reference"]
    rng = np.random.default_rng([course.seed, number])
    guess = _family(course, {height: (x, reference)}, {})
    standing = number >= _SECOND_PASS
    count = max(round(_STATES * min(course.effort, 1.0)), _FEWEST)
    distances = rng.uniform(*((9.5, 30.0) if standing else (8.0, 16.0)), count)
    skill = Jump(guess, course.run, course.kind.affordance, course.kind.clip)
    states = course.kind.simulator(course.run).harvest(skill, distances, rng, standing)
    for place, stage in enumerate(stages):
        problem = JumpProblem(course.kind, course.run, height, x, reference, states, [stage])
        if beyond is not None:
            problem.predict(beyond)
        file = None if course.folder is None else course.folder / f"search-{number}-{place}.npz"
        seed = course.seed + 1000 * number + place
        learned = learn(problem, seed, file, course.workers, course.on_progress)
        assert learned is not None
        x = learned
        if not (stage.scale[jump.parameter_slices()["m_sp"]] > 0).any():
            reference = problem.record(x)
    if done is not None:
        write_archive(done, _TRAINING, _VERSION, identity, {"x": x, "reference": reference})
    return x, reference
