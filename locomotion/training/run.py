"""Learning to run: first guess, curriculum and objective."""

import os
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any

import numpy as np

from locomotion import controller as c
from locomotion.skill import RUN_SKILL, RunSkill, run_clip
from locomotion.training.loop import Stage
from locomotion.training.path_trial import PathScenario, draw_path, follow_path
from locomotion.training.rollout import Scenario, Simulator, stays_up
from locomotion.training.run_trials import MIDDLE, cost, draw_scenario
from locomotion.training.training import Training

__all__ = [
    "RunProblem",
    "curriculum",
    "first_guess",
    "first_state_reference",
    "fit_step_length",
    "genes_scale",
    "scales",
    "skill_of",
    "train_run",
]

_SPREAD = np.array([0.1, 1.0, 0.03, 0.3, 0.5, 0.1, 0.05, 0.1, 1.0, 1.0, 0.2, 0.04])
"""Typical deviation of each sensor while running."""


def first_guess() -> np.ndarray:
    """Parameters (p,) float64 from which learning starts: SIMBICON's balance feedback around the clip."""
    x = np.zeros(sum(c.PARAMETERS.values()))
    part = c.parameter_slices()
    m_ap, m_sp = np.zeros((9, c.RANK)), np.zeros((c.RANK, 12))
    sensor = {name: i for i, name in enumerate(c.SENSORS)}
    action = {name: i for i, name in enumerate(c.ACTIONS)}
    m_sp[0, sensor["vx"]], m_sp[0, sensor["dx"]] = 0.15, 0.3
    m_ap[action["swing_hip_flexion"], 0] = 1.0
    m_sp[1, sensor["vy"]], m_sp[1, sensor["dy"]] = 0.2, 0.4
    m_ap[action["swing_hip_abduction"], 1] = 1.0
    m_ap[action["stance_hip_flexion"], 2] = 1.0
    x[part["m_ap"]], x[part["m_sp"]] = m_ap.ravel(), m_sp.ravel()
    x[part["posture"]] = [1.0, 1.0, 0.7, 0.8, 0.1, 0.8, 0.1, 0.5, 0.05]
    x[part["timing"]] = [0.36, 1.0]
    x[part["arms"]] = 1.0
    return x


def scales() -> np.ndarray:
    """How far a parameter may reasonably move, (p,) float64."""
    x = np.ones(sum(c.PARAMETERS.values()))
    part = c.parameter_slices()
    x[part["m_ap"]] = 1.0
    x[part["m_sp"]] = np.tile(0.1 / _SPREAD, c.RANK)
    x[part["posture"]] = [0.5, 0.5, 0.5, 0.5, 0.05, 0.5, 0.05, 0.5, 0.05]
    x[part["a_hat"]] = 0.15
    x[part["feed_forward"]] = 0.3
    x[part["turn"]] = 0.5
    x[part["climb"]] = 2.0
    x[part["descend"]] = 2.0
    x[part["climb_legs"]] = x[part["descend_legs"]] = 1.5
    x[part["bend"]] = 0.1
    x[part["climb_timing"]] = x[part["descend_timing"]] = [0.2, 0.8]
    x[part["timing"]] = [0.06, 0.25]
    x[part["arms"]] = 0.2
    return x


def first_state_reference() -> np.ndarray:
    """Reference sensors over a step, (9, 12) float64, before any running has been seen."""
    phase = np.linspace(0.0, 1.0, 9)
    table = np.zeros((9, 12))
    table[:, 0] = 0.09
    table[:, 2] = 0.93
    table[:, 5] = 0.36 * (phase - 0.28)
    table[:, 11] = 0.06
    return table


_STRAIGHT = ("m_ap", "m_sp", "posture", "a_hat", "feed_forward", "timing", "arms")
"""Blocks of `controller.PARAMETERS` that count straight on on level ground."""
_LEVEL = (*_STRAIGHT, "turn", "bend")
"""Those that count on level ground."""
_UP, _DOWN = (tuple(f"{way}{term}" for term in ("", "_legs", "_timing")) for way in ("climb", "descend"))
"""Those that count uphill, and downhill."""
KNOTS = np.array([1.2, 2.0, 2.5, 3.0, 3.5, 4.0, 4.5, 5.0])
"""Speeds [m/s] of the rows of a learned table; the first is that of a walk from which it begins to run."""
SPEED_RANGE = (1.5, 5.0)
"""Speeds [m/s] that may be asked for."""
SIZE = sum(c.PARAMETERS.values())
BLOCKS = ("base", "slope", "bend", "slow", "slowest", "faster", "fastest")
"""Of SIZE genes each: parameters at `MIDDLE`, their change per m/s and per (m/s)^2 from 2.5 to 4 m/s; how the
rows beyond differ from their neighbours: that at 2 from that at 2.5 m/s, that at 1.2 from that at 2, that at
4.5 from that at 4 and that at 5 from that at 4.5."""


def skill_of(
    genes: np.ndarray, reference: np.ndarray, max_lateral: float = 1.6, meta: dict | None = None
) -> RunSkill:
    """The skill that ``genes`` (len(BLOCKS) * SIZE,) stand for, see `BLOCKS`."""
    base, slope, bend, slow, slowest, faster, fastest = genes.reshape(len(BLOCKS), SIZE)
    u = (KNOTS[2:6] - MIDDLE)[:, None]
    table = np.empty((len(KNOTS), SIZE))
    table[2:6] = base + u * slope + u * u * bend
    table[1] = table[2] + slow
    table[0] = table[1] + slowest
    table[6] = table[5] + faster
    table[7] = table[6] + fastest
    time = c.parameter_slices()["timing"].start
    table[:, time] = np.clip(table[:, time], 0.22, 0.5)
    return RunSkill(KNOTS, table, reference, SPEED_RANGE, max_lateral, (0.3, 0.25), run_clip(), meta or {})


def genes_scale(base: float, slope: float, bend: float, *names: str) -> np.ndarray:
    """Scale of the genes of the family where only the blocks ``names`` of `controller.PARAMETERS` are free,
    each weighted; of the third only those that shape the step."""
    shape = _blocks(*(name for name in names if name not in ("m_ap", "m_sp", "posture")))
    return _genes(base * _blocks(*names), slope * _blocks(*names), bend * shape)


def _genes(*blocks: np.ndarray) -> np.ndarray:
    """All genes from those of the first `BLOCKS`; the others are 0."""
    return np.concatenate([*blocks, np.zeros((len(BLOCKS) - len(blocks)) * SIZE)])


def _blocks(*names: str) -> np.ndarray:
    """Scale of one row's parameters where only the blocks ``names`` are free, (SIZE,)."""
    one, part, free = scales(), c.parameter_slices(), np.zeros(SIZE)
    for name in names:
        free[part[name]] = one[part[name]]
    return free


def rows_scale(
    slow: float = 0.0, slowest: float = 0.0, faster: float = 0.0, fastest: float = 0.0
) -> np.ndarray:
    """Scale of all genes where only rows of their own are free, each weighted; slopes are left to what was
    learned between them."""
    free = _blocks(*_LEVEL)
    return np.concatenate([np.zeros(3 * SIZE), slow * free, slowest * free, faster * free, fastest * free])


WAY: dict[str, Any] = {"length": (12.0, 20.0), "beyond": 10.0, "radius": 6.0, "speeds": (2.6, 3.6)}
"""A path that is run from where the person has walked a few steps, without bends in which it would walk."""
_WAY_TAKES = 9.0  # [s]
_PUSHED = {"speeds": (3.2, 3.7), "steady": True, "push": 330.0, "noise": 0.3, "duration": 7.0}
_ANY_SPEED = {"speeds": (2.6, 3.9), "steady": True, "push": 250.0, "noise": 0.3, "duration": 7.0}
_FROM_A_WALK = {"speeds": (2.8, 3.6), "walking": 1.0, "push": 100.0, "noise": 0.1, "duration": 5.0}
_SLOW_RUN = {"speeds": (1.7, 2.3), "steady": True, "noise": 0.3, "push": 200.0, "duration": 4.0}
WAYS = (
    WAY, _FROM_A_WALK, {**WAY, "ground": "gentle"}, _ANY_SPEED, {**WAY, "push": 60.0},
    {**WAY, "length": (10.0, 12.0)}, _SLOW_RUN,
)  # fmt: skip
HARD_PUSHES = (
    WAY, _PUSHED, {**WAY, "ground": "gentle"}, _PUSHED, _ANY_SPEED, _PUSHED, {**WAY, "length": (10.0, 12.0)},
    _PUSHED, _FROM_A_WALK, _SLOW_RUN,
)  # fmt: skip
_STEADY = {"steady": True, "noise": 0.3, "duration": 4.0}
SLOW = ({**_STEADY, "speeds": (1.95, 2.45), "lateral": 1.0},)
SLOWER = (
    {**_STEADY, "speeds": (1.5, 2.2)},
    {**_STEADY, "speeds": (1.7, 2.4), "push": 200.0},
    {**_STEADY, "speeds": (1.7, 2.4), "lateral": 1.4},
)
FASTER = ({**_STEADY, "speeds": (4.1, 4.6), "lateral": 1.2},)
FASTEST = ({**_STEADY, "speeds": (4.3, 5.0), "lateral": 1.6},)
_LONGER = {**_STEADY, "speeds": (4.05, 5.0), "duration": 6.0}
FAST_BENDS_AND_PUSHES = {**_LONGER, "lateral": 1.9, "push": 60.0}, {**_LONGER, "push": 320.0}
_TOP_PUSH = {**_STEADY, "speeds": (4.7, 5.0), "push": 330.0, "duration": 5.0}
_TOP_BEND = {**_STEADY, "speeds": (4.6, 5.0), "lateral": 2.0, "duration": 6.0}
TOP = _TOP_BEND, _TOP_PUSH, _TOP_PUSH
_HARD_TOP_PUSH = {**_TOP_PUSH, "speeds": (4.85, 5.0), "push": 360.0}
TOP_PUSHES = (
    _HARD_TOP_PUSH, _TOP_BEND, _HARD_TOP_PUSH, _HARD_TOP_PUSH, _HARD_TOP_PUSH,
    {**_HARD_TOP_PUSH, "speeds": (4.5, 5.0)},
)  # fmt: skip
_SLOW_PUSH = {**_STEADY, "speeds": (1.8, 2.3), "push": 330.0, "duration": 5.0}
SLOW_PUSHES = (
    _SLOW_PUSH, {**_SLOW_PUSH, "speeds": (1.8, 2.5), "lateral": 1.2, "push": 60.0},
    _SLOW_PUSH, _FROM_A_WALK,
)  # fmt: skip
FLAT, BENDS = {"lateral": 0.0}, {"lateral": 1.8}
HILLS = {"tilt": 0.18}, BENDS, {"tilt": 0.18, "lateral": 1.2}
EVERY = genes_scale(1, 0.5, 0, *_LEVEL) + rows_scale(slow=0.5, slowest=0.5)


def set_off(slowest: float, fastest: float) -> tuple[dict[str, Any], ...]:
    """Kinds of trials of setting off from a walk to a speed [m/s]; among them slow runs, which share rows."""
    walked = {"walking": 1.0, "noise": 0.1, "speeds": (slowest, fastest)}
    return walked, walked, _SLOW_RUN, walked


def curriculum(training: Training) -> tuple[Stage, ...]:
    """The stages from nothing to the whole family. A stage's ``fall`` is what each fall costs besides the
    time that is lost."""

    def stage(
        name: str,
        generations: int,
        sigma: float,
        scale: np.ndarray,
        trials: int,
        kinds: tuple[dict, ...] = ({},),
        style: float = 0.4,
        fall: float = 0.0,
        population: int = 32,
        **trial: Any,
    ) -> Stage:
        options = {"trials": trials, "style": style, "fall": fall, "trial": trial, "kinds": kinds}
        seconds = sum(({**trial, **kinds[i % len(kinds)]}).get("duration", _WAY_TAKES) for i in range(trials))
        return Stage(name, training.generations(generations), sigma, scale, options, population, seconds)

    middle, family = genes_scale(1, 0, 0, *_STRAIGHT), genes_scale(1, 1, 0, *_LEVEL)
    up, down = genes_scale(1, 0, 0, *_UP), genes_scale(1, 0, 0, *_DOWN)
    first: dict[str, Any] = {"style": 0.1, "population": 48, "noise": 0.2}
    fast: dict[str, Any] = {"speeds": (2.4, 4.4), "steady": True, "noise": 0.4, "push": 100.0}
    steep: dict[str, Any] = {"speeds": (2.5, 3.4), "noise": 0.3, "duration": 4.0}
    beginning = rows_scale(slow=0.5, slowest=1)
    return (
        stage("first steps", 8, 0.20, middle, 1, duration=0.8, **first),
        stage("first second", 25, 0.18, middle, 1, duration=1.6, **first),
        stage("four seconds", 45, 0.18, middle, 1, duration=4.0, **first),
        stage("twelve seconds", 40, 0.16, middle, 2, duration=10.0, noise=0.2),
        stage("pushes", 20, 0.07, middle, 6, duration=6.0, noise=0.5, push=60.0),
        stage(
            "speeds",
            30,
            0.06,
            genes_scale(1, 1, 1, *_LEVEL),
            5,
            duration=5.0,
            noise=0.5,
            push=100.0,
            speeds=(2.9, 4.1),
            lateral=0.7,
        ),
        stage("flat", 30, 0.05, family, 5, duration=4.5, **fast),
        stage("bends", 40, 0.045, family, 8, (FLAT, BENDS, BENDS, BENDS), duration=4.0, **fast),
        stage("gentle climbs", 25, 0.10, up, 3, style=0.2, climb=(0.06, 0.16), **steep),
        stage("climbs", 40, 0.08, up, 4, style=0.2, climb=(0.05, 0.24), push=40.0, **steep),
        stage("gentle descents", 25, 0.10, down, 3, style=0.2, climb=(-0.16, -0.06), **steep),
        stage("descents", 40, 0.08, down, 4, style=0.2, climb=(-0.24, -0.05), push=40.0, **steep),
        stage(
            "tight bends",
            20,
            0.06,
            genes_scale(1, 0, 0, "turn", "bend"),
            4,
            duration=5.0,
            **{**fast, "lateral": 2.2, "push": 0.0},
        ),
        stage("hills", 25, 0.04, genes_scale(1, 0, 0, *_LEVEL, *_UP, *_DOWN), 6, HILLS, duration=4.0, **fast),
        stage("slow", 40, 0.05, rows_scale(slow=1), 5, SLOW, style=0.3),
        stage("slower", 40, 0.05, rows_scale(slow=1, slowest=0.5), 6, SLOWER, style=0.3),
        stage("jog on", 12, 0.05, beginning, 3, set_off(1.5, 1.7), style=0.3, duration=3.0),
        stage("set off slowly", 20, 0.04, beginning, 4, set_off(1.6, 2.6), style=0.3, duration=3.0),
        stage("set off", 40, 0.04, beginning, 4, set_off(2.4, 3.6), style=0.3, duration=4.0),
        stage("ways", 40, 0.04, EVERY, len(WAYS), WAYS, style=0.3),
        stage("hard pushes", 40, 0.025, EVERY, len(HARD_PUSHES), HARD_PUSHES, style=0.3, fall=3.0),
        stage("slow pushes", 30, 0.04, rows_scale(slow=1), 8, SLOW_PUSHES, style=0.3, fall=3.0),
        stage("faster", 40, 0.05, rows_scale(faster=1), 5, FASTER, style=0.3),
        stage("fastest", 40, 0.05, rows_scale(faster=0.5, fastest=1), 5, FASTEST, style=0.3),
        stage(
            "fast bends and pushes",
            45,
            0.035,
            rows_scale(faster=1, fastest=1),
            8,
            FAST_BENDS_AND_PUSHES,
            style=0.3,
        ),
        stage("top", 40, 0.04, rows_scale(faster=0.2, fastest=1), 6, TOP, style=0.3),
        stage(
            "top pushes",
            60,
            0.03,
            rows_scale(fastest=1),
            12,
            TOP_PUSHES,
            style=0.3,
            fall=6.0,
            population=24,
        ),
    )


def train_run(training: Training, out: str | os.PathLike[str] = RUN_SKILL) -> RunSkill:
    """Learn to run from nothing and write the skill to ``out``."""
    genes = _genes(first_guess())
    amplitude = c.parameter_slices()["timing"].start + 1
    genes[SIZE + amplitude] = 0.08  # longer steps at higher speed
    problem = RunProblem(curriculum(training), genes, first_state_reference())
    skill = skill_of(training.learn(problem), problem.reference, meta=training.made_by("run"))
    skill = replace(skill, step_length=fit_step_length(skill))
    skill.save(out)
    return skill


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
    """Learning of the run for `locomotion.training.loop.learn`.

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
                draw_path(rng, **kind) if "length" in kind else draw_scenario(rng, **{**base, **kind})
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
            costs += cost(trial, scenario.duration, stage.options["style"])
            costs += stage.options["fall"] * (not stays_up(trial, scenario.duration))
            survived += trial.figures["time"] / scenario.duration
        return costs / len(scenarios), survived / len(scenarios)


@lru_cache(maxsize=1)
def _simulator() -> Simulator:
    """This process's simulator."""
    return Simulator()
