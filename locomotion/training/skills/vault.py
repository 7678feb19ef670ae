"""Training of the vault.

At first it follows the clip, with feed-forward only and through a wall that only the hand feels; then over
the wall, to land and run on, with feedback, at growing heights. Greater heights start from the take-off of
higher jumps. Finally every height is refined on longer trials.
"""

import os
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from locomotion.body.learned_file import learned_numbers
from locomotion.gaits.run.skill import RunSkill, load_run_skill
from locomotion.skills.jump import kernel as jump
from locomotion.skills.jump.skill import load_jump_skill, run_digest
from locomotion.skills.skill_file import SkillFamily, family_file
from locomotion.skills.vault import kernel as vault
from locomotion.skills.vault.skill import KIND, VAULT_SKILL, Vault, tables_of, vault_clip
from locomotion.training.progress import Clock
from locomotion.training.search.loop import Stage, simulated
from locomotion.training.skills.jump_trial import StartState
from locomotion.training.skills.vault_trial import VaultOutcome, VaultSimulator
from locomotion.training.training import Training

__all__ = ["ENTRY_SPEED", "HEIGHTS", "VaultProblem", "cost", "first_guess", "scales", "train_vault"]

HEIGHTS = (0.6, 0.8)
"""Heights [m] learned one after the other: each search begins at the one before and raises the wall as it
goes."""
FURTHER = (0.9, 1.0)
"""Heights [m] learned after these: the first predicted from the one before and from what higher jumps do
otherwise, the next as the wall rises."""
ENTRY_SPEED = 3.3
"""[m/s]"""
DEPTHS = (0.2, 0.4)
"""Least and greatest thickness [m] of the walls."""
BEGINNINGS = 6
"""How often learning begins anew, to go on from the best: half of them find no way over the wall."""
_STATES = 48
_SHARES = (0.0, 0.25, 0.5, 0.75, 1.0)
# of what a jump 0.2 m higher does otherwise: the best is where learning over a higher wall starts
_POSE = 3.0  # cost of a mean squared difference to the clip [1/rad²]
_TRAINING = "vault training"
_PART = vault.parameter_slices()
_REFERENCE = (vault.STEPS, vault.BINS, vault.SENSORS)
_SENSED = (vault.STEPS * vault.BINS, vault.SENSORS)


def first_guess() -> np.ndarray:
    """Parameters (p,) from which learning starts: the jump onto 0.5 m with the vault's clip, the arm
    reaching."""
    x = np.zeros(sum(vault.PARAMETERS.values()))
    jumped, part = load_jump_skill().at(0.5)[0], jump.parameter_slices()
    x[_PART["a_hat"]] = _spread(jumped[part["a_hat"]]).ravel()
    x[_PART["lateral"]] = np.repeat(jumped[part["lateral"]].reshape(jump.STEPS, 1, 6), 3, axis=1).ravel()
    for name in ("beta", "alpha", "marks", "gains"):
        x[_PART[name]] = jumped[part[name]]
    x[_PART["arm"]] = [0.22, 0.45, 0.06, 0.3, 0.4, 0.0, 0.0, 0.0]
    m_ap = np.zeros((9, vault.RANK))
    m_ap[0, 0] = m_ap[3, 1] = m_ap[1, 2] = 1.0
    m_ap[6, 1] = 0.5
    x[_PART["m_ap"]] = m_ap.ravel()
    x[_PART["entry"]] = ENTRY_SPEED
    return x


def _spread(a_hat: np.ndarray) -> np.ndarray:
    """A jump's knots (96,) on the vault's, (4, 5, 6)."""
    old, new = np.linspace(0.0, 1.0, jump.KNOTS), np.linspace(0.0, 1.0, vault.KNOTS)
    steps = a_hat.reshape(jump.STEPS, jump.KNOTS, 6)
    return np.array([[np.interp(new, old, column) for column in step.T] for step in steps]).transpose(0, 2, 1)


def higher() -> np.ndarray:
    """The change (p,) of a vault that takes off as a jump 0.2 m higher does."""
    jumps, part = load_jump_skill(), jump.parameter_slices()
    more = jumps.at(0.7)[0] - jumps.at(0.5)[0]
    x = np.zeros(sum(vault.PARAMETERS.values()))
    a_hat = _spread(more[part["a_hat"]])
    a_hat[2:] = 0.0
    x[_PART["a_hat"]], x[_PART["marks"]] = a_hat.ravel(), more[part["marks"]]
    x[_PART["beta"]][:2] = more[part["beta"]][:2]
    return x


def scales(what: str) -> np.ndarray:
    """How far a parameter may reasonably move, (p,) float64; others stay. ``what``: "feed-forward" or
    "feedback" (everything)."""
    x = np.zeros(sum(vault.PARAMETERS.values()))
    a_hat = np.full((vault.STEPS, vault.KNOTS, 6), 0.35)
    lateral = np.full((vault.STEPS, 3, 6), 0.15)
    x[_PART["a_hat"]], x[_PART["lateral"]] = a_hat.ravel(), lateral.ravel()
    x[_PART["beta"]] = 0.12
    x[_PART["alpha"]] = 0.2
    x[_PART["marks"]] = 0.12
    x[_PART["arm"]] = [0.08, 0.1, 0.06, 0.3, 0.25, 0.2, 0.15, 0.1]
    if what == "feedback":
        x[_PART["gains"]] = np.tile(np.r_[np.full(6, 0.5), 0.4, np.full(6, 0.25), 0.2], 3)
        run = [0.1, 1.0, 0.1, 0.4, 0.8, 0.15, 0.08, 0.15, 1.0, 1.0, 0.25, 0.05]
        spread = np.array([*run, *(0.1, 0.1, 0.08), *(0.1, 0.1, 0.08)])  # ..., swing foot, hand
        m_sp = np.tile(0.06 / spread, (vault.PHASES, vault.RANK, 1))
        m_sp[1:, :, 15:] = 0.0  # the hand counts in the first phase only
        x[_PART["m_sp"]] = m_sp.ravel()
        x[_PART["m_ap"]] = 0.4
    return x


def cost(outcome: VaultOutcome, entry: float, pose: float = _POSE) -> float:
    """Objective of one trial: equations 10 and 11 with terms for how long the hand holds and what it
    bears. ``pose``: what a difference to the clip costs [1/rad²]."""
    speed = abs(outcome.speed - entry) if outcome.steps >= 2 else 1.5
    beside = max(abs(outcome.planted - 0.5) - 0.15, 0.0) if outcome.held else 0.5
    return (
        10.0 * (1.0 - outcome.time)
        + (0.0 if outcome.cleared else 3.0)
        + 15.0 * min(outcome.shortfall, 1.0)
        + 0.25 * min(outcome.scrape, 12)
        + 6.0 * outcome.missed
        + 8.0 * beside
        + 3.0 * (1.0 - min(outcome.held / 15.0, 1.0))
        + 3.0 * (1.0 - min(max(outcome.impulse, 0.0) / 60.0, 1.0))
        + 0.8 * speed
        + 0.8 * min(outcome.drift, 1.0)
        + 2.0 * outcome.reaction
        + 0.03 * outcome.effort
        + 3.0 * outcome.trunk
        + 6.0 * outcome.yaw
        + 12.0 * outcome.headlong
        + 15.0 * outcome.sunk
        + pose * outcome.pose
    )


@dataclass
class VaultProblem:
    """One stage: what `learn` needs.

    family: what was learned before; what is learned is a change (p,) of its member at the stage's first
    height, or the one nearest to it. states: harvested from planned run-ups. stage: its options are
    ``heights`` (2,) [m], from the first to the second of which the wall rises, ``same``: whether every
    generation has the same trials, ``states`` per generation, ``error`` [m] added to the distance,
    ``duration`` [s], ``pull`` towards no change, ``failed``: what a trial costs in addition that is no
    vault, ``refines``: whether the expected sensors stay as they are, ``solid``: whether the wall stops more
    than the hand, ``pose``: see `cost`, ``beginnings``: how many searches, of which the best counts. initial:
    where the search begins.
    """

    run: RunSkill
    family: SkillFamily
    states: list[StartState]
    stage: Stage
    initial: np.ndarray
    _simulator: VaultSimulator | None = None

    def stages(self) -> Sequence[Stage]:
        """The one stage."""
        return [self.stage]

    def start(self) -> np.ndarray:
        """The first change, (p,)."""
        return self.initial

    def predict(self, change: np.ndarray) -> None:
        """Begin with the share of ``change`` (p,) that serves best from all start states."""
        self.initial = self.best([share * change for share in _SHARES])

    def best(self, changes: list[np.ndarray]) -> np.ndarray:
        """The one of ``changes``, each (p,), that serves best from all start states."""
        height = self.stage.options["heights"][1]
        every = [(i, state.error, height, 0.5 * sum(DEPTHS)) for i, state in enumerate(self.states)]
        found = min(changes, key=lambda change: self.evaluate(self.stage, change, every)[0])
        self._simulator = None  # it cannot be sent to workers
        return found

    def scenarios(self, stage: Stage, generation: int, rng: np.random.Generator) -> list[tuple]:
        """(start state, error of the distance [m], height [m], depth [m]) of each trial of a generation."""
        options = stage.options
        count, (low, high) = options["states"], options["heights"]
        if options["same"]:
            rng = np.random.default_rng(count)
        chosen = rng.permutation(len(self.states))[:count]
        even = (np.arange(count) + rng.random(count)) / count
        errors = options["error"] * rng.permutation(2.0 * even - 1.0)
        depths = rng.uniform(*DEPTHS, count)
        height = low + (high - low) * min(generation / max(0.85 * stage.generations, 1.0), 1.0)
        return [
            (int(i), self.states[i].error + float(e), height, float(d))
            for i, e, d in zip(chosen, errors, depths, strict=False)
        ]

    def evaluate(self, stage: Stage, candidate: np.ndarray, scenarios: list) -> tuple[float, float]:
        """Mean cost with the pull towards no change, and the share that vaulted."""
        if self._simulator is None:
            self._simulator = VaultSimulator(self.run)
        member = member_of(self.family, stage)
        reference = self.family.references[member].reshape(_REFERENCE)
        tables = tables_of(self.family.table[member] + candidate, reference, self.run)
        options, total, vaulted = stage.options, 0.0, 0
        for state, error, height, depth in scenarios:
            result = self._simulator.vault_trial(
                tables, (height, depth), self.states[state], error, options["duration"], options["solid"]
            )
            total += cost(result, tables.entry, options["pose"]) + options["failed"] * (not result.vaulted)
            vaulted += result.vaulted
        free = stage.scale > 0
        away = candidate[free] / stage.scale[free]
        n = len(scenarios)
        return total / n + options["pull"] * float(np.mean(away**2)), vaulted / n


def member_of(family: SkillFamily, stage: Stage) -> int:
    """Which member of the family a stage changes."""
    return int(np.argmin(np.abs(family.heights - stage.options["heights"][0])))


def curriculum(training: Training) -> list[Stage]:
    """The stages: each ends with a member of the family at its last height."""
    low = HEIGHTS[0]
    usual = {"error": 0.08, "duration": 2.0, "pull": 0.1, "failed": 0.0, "refines": False}
    usual |= {"heights": (low, low), "same": True, "solid": True, "pose": _POSE, "beginnings": 1}

    def stage(name: str, count: int, sigma: float, what: str, **options) -> Stage:
        options = {**usual, **options}
        seconds = options["states"] * options["duration"]
        # at first hardly anybody comes over the wall, and one or two trials tell no candidates apart
        return Stage(name, training.generations(count), sigma, scales(what), options, 20, seconds, least=3)

    through = {"solid": False, "error": 0.04}
    clip = {"states": 3, "duration": 1.8, "pose": 40.0, "beginnings": BEGINNINGS, **through}
    landing = {"states": 4, "duration": 2.2, "pose": 10.0, "pull": 0.02, **through}
    stages = [
        stage(f"{low:g} m, clip", 50, 0.2, "feed-forward", **clip),
        stage(f"{low:g} m, landing", 80, 0.2, "feed-forward", **landing),
        stage(f"{low:g} m, feedback", 60, 0.12, "feedback", states=16, error=0.06, duration=2.5),
    ]
    for pair in pairwise(HEIGHTS):
        name = f"{pair[0]:g} to {pair[1]:g} m"
        stages.append(stage(name, 40, 0.12, "feedback", states=10, heights=pair))
    first, last = FURTHER
    further = {"states": 16, "error": 0.06, "duration": 2.6, "pull": 0.05, "heights": (first, first)}
    rising = {"states": 8, "error": 0.06, "pull": 0.02, "heights": FURTHER}
    long = {"states": 10, "duration": 4.0, "pull": 0.05, "failed": 4.0, "refines": True, "same": False}
    return [
        *stages,
        stage(f"{first:g} m", 30, 0.08, "feedback", **further),
        stage(f"{first:g} to {last:g} m", 45, 0.12, "feedback", **rising),
        *(
            stage(f"{height:g} m, refined", 40, 0.06, "feedback", heights=(height, height), **long)
            for height in (*HEIGHTS, *FURTHER)
        ),
    ]


def train_vault(training: Training, out: str | os.PathLike[str] = VAULT_SKILL) -> SkillFamily:
    """Learn vaults over all of `HEIGHTS` and `FURTHER` on the package's run and write them to ``out``.
    The training's checkpoint is a folder."""
    run, seed = load_run_skill(), training.seed
    stages = curriculum(training)
    training.prepare("vault", out, stages, ("walk", "run", "speed-up", "jump"), clip=vault_clip().digest)
    stride = VaultSimulator(run).fit_stride(ENTRY_SPEED, np.random.default_rng([seed, 1]))
    blank = np.zeros((1, vault.STEPS * vault.BINS, vault.SENSORS))
    guess = first_guess()[None]
    made_by = training.made_by("vault")
    family = SkillFamily(KIND, np.array(HEIGHTS[:1]), guess, blank, stride, run_digest(run), made_by)
    rng = np.random.default_rng([seed, 2])
    states = _harvest(family, run, rng)
    clock = Clock(sum(_all_simulated(stage) for stage in stages))
    refined = np.zeros_like(family.table[0])  # what the last member changed when it was refined
    for number, stage in enumerate(stages):
        width = len(family.table[0])
        schema = family_file(KIND, width, _SENSED)
        arrays = training.recall(
            _TRAINING, number, {**schema.arrays_of(None), "refined": learned_numbers(width)}
        )
        if arrays is not None:
            refined = arrays.pop("refined")
            family = replace(family, **arrays)
            clock.skip(_all_simulated(stage))
            continue
        problem = VaultProblem(run, family, states, stage, np.zeros_like(family.table[0]))
        if stage.options["heights"][0] > family.heights[-1]:
            problem.predict(higher())
        elif refined.any():
            problem.predict(refined)
        found = [
            training.learn(problem, 1000 * number + k, f"search-{number}-{k}", clock)
            for k in range(stage.options["beginnings"])
        ]
        change = problem.best(found)
        if stage.options["refines"]:
            training.demand_success("vault", problem, change)
        family = changed(family, change, stage, run, states)
        refined = change if stage.options["refines"] else refined
        arrays = {"heights": family.heights, "table": family.table, "references": family.references}
        training.keep(_TRAINING, number, {**arrays, "refined": refined})
    family.save(out)
    return family


def _all_simulated(stage: Stage) -> float:
    """What all searches of a stage simulate [s], about."""
    return stage.options["beginnings"] * simulated([stage])


def _harvest(family: SkillFamily, run: RunSkill, rng: np.random.Generator) -> list[StartState]:
    """Start states from planned run-ups, half of them from standing."""
    simulator, skill, half = VaultSimulator(run), Vault(family, run), _STATES // 2
    running = simulator.harvest(skill, rng.uniform(8.0, 16.0, half), rng)
    return running + simulator.harvest(skill, rng.uniform(9.5, 30.0, half), rng, standing=True)


def changed(
    family: SkillFamily, change: np.ndarray, stage: Stage, run: RunSkill, states: list[StartState]
) -> SkillFamily:
    """The family after a stage that has found ``change`` (p,): the member that it began with becomes, with
    the change, the member at the stage's last height; its sensors are recorded anew where it is not
    refined."""
    height, member = stage.options["heights"][1], member_of(family, stage)
    parameters, reference = family.table[member] + change, family.references[member]
    if not stage.options["refines"]:
        recorded = _record(run, parameters, reference.reshape(_REFERENCE), height, states)
        reference = recorded.reshape(reference.shape)
    keep = np.abs(family.heights - height) > 1e-9
    at = int(np.searchsorted(family.heights[keep], height))
    return replace(
        family,
        heights=np.insert(family.heights[keep], at, height),
        table=np.insert(family.table[keep], at, parameters, axis=0),
        references=np.insert(family.references[keep], at, reference, axis=0),
    )


def _record(
    run: RunSkill, parameters: np.ndarray, reference: np.ndarray, height: float, states: list[StartState]
) -> np.ndarray:
    """Mean sensors of the cleared vaults without errors, (4, 6, 18); ``reference`` where there is none."""
    sums = np.zeros((vault.STEPS, vault.BINS, vault.SENSORS + 1))
    simulator, tables = VaultSimulator(run), tables_of(parameters, reference, run)
    for state in states[:16]:
        one = np.zeros_like(sums)
        if simulator.vault_trial(tables, (height, 0.3), state, state.error, 2.0, record=one).cleared:
            sums += one
    counts = sums[..., -1:]
    return np.where(counts > 0, sums[..., :-1] / np.maximum(counts, 1.0), reference)
