"""Training to walk: the gains of the walking controller, from level to rough ground; then how they differ on
steep ground, for coming to rest there, and on stairs."""

import os
from dataclasses import dataclass
from typing import Any

import numpy as np

from locomotion.gaits.walk.layout import (
    FAST,
    GAINS,
    LEVEL,
    REST,
    STAIRS,
    STEEP,
    USUAL_SPEED,
    first_gains,
    gain_limits,
)
from locomotion.gaits.walk.skill import TABLES, WALK_SKILL, WalkSkill
from locomotion.training.gaits.path_trial import (
    TURNING,
    PathScenario,
    draw_flight,
    draw_path,
    draw_turns,
    follow_path,
)
from locomotion.training.search.loop import Stage
from locomotion.training.training import Training

__all__ = ["KINDS", "WalkProblem", "draw_walk", "train_walk", "walk_curriculum", "walk_tables"]

FASTEST = 2.0
"""Fastest walk [m/s]."""
_STEPS_PER_S = 1.9  # [steps/s] of people who walk at 1.3 m/s; it grows with the root of the speed
_BEHIND = 6.0  # cost per m/s of being slower or faster than its reference, except on steep ground and stairs
_RESTLESS = 1.0  # cost of the time to come to rest, relative to the time allowed
_QUICK = ("swing_time", "transfer_time", "width")  # how soon, and how far aside, a step catches a turn
_FLIGHT = 4.5  # [m] approximate path over a flight of stairs
_UNIT = 0.08  # share of a gain's range in one unit of the search


def _kind(
    ground: str,
    speeds: tuple[float, float],
    radius: float,
    length: tuple[float, float] = (4.0, 9.0),
    **options: Any,
) -> dict[str, Any]:
    return {"ground": ground, "speeds": speeds, "radius": radius, "length": length, **options}


KINDS: dict[str, dict[str, Any]] = {
    "level": _kind("level", (0.6, USUAL_SPEED), 0.8),
    "pushed": _kind("level", (0.6, USUAL_SPEED), 1.0, push=80.0),
    "rolling": _kind("rolling", (0.6, USUAL_SPEED), 1.0),
    "ramps": _kind("ramps", (0.8, USUAL_SPEED), 1.2, length=(9.0, 15.0)),
    "moguls": _kind("moguls", (0.4, 0.8), 1.0),
    "crags": _kind("crags", (0.4, 0.8), 2.0),
    "ridges": _kind("ridges", (0.4, USUAL_SPEED), 1.0, length=(2.0, 2.5)),
    "stairs": {"ground": "stairs", "speeds": (0.8, USUAL_SPEED)},
    "told elsewhere": {"ground": "level", "speeds": (0.8, USUAL_SPEED), "turns": True},
    "fast": _kind("level", (USUAL_SPEED, FASTEST), 4.0, length=(8.0, 14.0)),
    "fast, pushed": _kind("level", (USUAL_SPEED, FASTEST), 8.0, length=(8.0, 14.0), push=80.0),
    "fast, rolling": _kind("rolling", (USUAL_SPEED, FASTEST), 8.0, length=(8.0, 14.0)),
    "fast, told elsewhere": {"ground": "level", "speeds": (USUAL_SPEED, FASTEST), "turns": True},
}
"""Trials as arguments of `draw_path`; on stairs of `draw_flight`, with ``turns`` of `draw_turns`."""


def draw_walk(rng: np.random.Generator, kind: dict[str, Any]) -> PathScenario:
    """A random path of a kind, one of the values of `KINDS`."""
    if kind["ground"] == "stairs":
        return draw_flight(rng, kind["speeds"])
    return draw_turns(rng, kind["speeds"]) if "turns" in kind else draw_path(rng, **kind)


def _seconds(kind: dict[str, Any]) -> float:
    """[s] approximate duration of a walk of a kind."""
    if "turns" in kind:
        return TURNING
    return float(np.mean(kind.get("length", _FLIGHT)) / np.mean(kind["speeds"]))


def walk_curriculum(training: Training) -> tuple[Stage, ...]:
    """From level ground to ramps and moguls, then steep ground, coming to rest on it, stairs and fast walks;
    finally how quick steps must be on all grounds to survive sudden turns."""
    low, high = gain_limits()
    unit = _UNIT * (high - low)

    def stage(
        name: str,
        generations: int,
        sigma: float,
        kinds: list[str],
        row: int = LEVEL,
        gains: tuple[str, ...] = tuple(GAINS),
    ) -> Stage:
        scale = np.zeros((TABLES, len(GAINS)))
        scale[row] = np.where([gain in gains for gain in GAINS], unit, 0.0)
        walked = tuple(KINDS[kind] for kind in kinds)
        seconds = sum(_seconds(kind) for kind in walked)
        generations = training.generations(generations)
        options = {"kinds": walked, "restless": _RESTLESS * (row == REST)}
        options["behind"] = _BEHIND * (row in (LEVEL, FAST))
        return Stage(name, generations, sigma, scale.ravel(), options, population=16, seconds=seconds)

    fast = ["fast"] * 4 + ["fast, pushed"] * 2 + ["fast, rolling"] * 2
    turns = ["told elsewhere"] * 14 + ["fast, told elsewhere"] * 6
    other = ["pushed", "rolling", "ramps", "stairs"] * 2 + ["moguls", "crags"]
    return (
        stage("level", 10, 0.5, ["level"] * 3 + ["rolling"]),
        stage("rolling", 20, 0.5, ["level"] + ["rolling"] * 3 + ["ramps"]),
        stage("ramps", 30, 0.5, ["pushed", "rolling"] + ["ramps"] * 3 + ["moguls"]),
        stage("moguls", 30, 0.4, ["pushed", "rolling"] + ["ramps"] * 2 + ["moguls"] * 2),
        stage("crags", 15, 0.8, ["crags"] * 6, row=STEEP),
        stage("rest", 20, 0.8, ["ridges"] * 12 + ["rolling", "ramps"], row=REST),
        stage("stairs", 25, 0.8, ["stairs"] * 12, row=STAIRS),
        stage("fast", 20, 0.5, fast, row=FAST),
        stage("told elsewhere", 8, 0.5, turns + other, gains=_QUICK),
    )


@dataclass(frozen=True)
class WalkProblem:
    """Learning of the walk for `locomotion.training.search.loop.learn`: its stages and the first guess of the
    parameters: the gains for level ground, what is added to them on steep ground, what is added to that while
    coming to rest, and what is added to the first on stairs."""

    curriculum: tuple[Stage, ...]
    parameters: np.ndarray

    def stages(self) -> tuple[Stage, ...]:
        """The curriculum."""
        return self.curriculum

    def start(self) -> np.ndarray:
        """The first guess."""
        return self.parameters

    def scenarios(self, stage: Stage, generation: int, rng: np.random.Generator) -> list[PathScenario]:
        """One random path of each of the stage's kinds."""
        return [draw_walk(rng, kind) for kind in stage.options["kinds"]]

    def evaluate(
        self, stage: Stage, candidate: np.ndarray, scenarios: list[PathScenario]
    ) -> tuple[float, float]:
        """Mean cost and mean share of the way covered; gains outside their limits cost and are cut."""
        tables, outside = walk_tables(candidate)
        walk = WalkSkill(tables, FASTEST)
        cost, covered = 4.0 * outside, 0.0
        for scenario in scenarios:
            f = follow_path(scenario, walk=walk).figures
            done = f["time"] / scenario.duration
            pace = _STEPS_PER_S * np.sqrt(max(f["speed"], 0.2) / 1.3)
            looks = (
                0.3 * abs(f["step_rate"] - pace) + 3.0 * f["trunk"] + 0.02 * f["effort"] + 0.05 * f["head"]
            )
            failed = 10.0 * (1.0 - done) + 2.0 * (done < 1.0) + stage.options["restless"] * f["restless"]
            failed += stage.options["behind"] * abs(f["behind"])
            cost += (failed + 1.5 * f["side_drift"] + looks) / len(scenarios)
            covered += done / len(scenarios)
        return cost, covered


def walk_tables(parameters: np.ndarray) -> tuple[np.ndarray, float]:
    """Gains (5, len(GAINS)) for ``parameters`` (5 len(GAINS),), cut at their limits, and how far they were
    outside in all, in shares of their ranges."""
    low, high = gain_limits()
    level, steep, rest, stairs, fast = parameters.reshape(TABLES, len(GAINS))
    wanted = np.stack([level, level + steep, level + steep + rest, level + stairs, level + fast])
    tables = np.clip(wanted, low, high)
    return tables, float((np.abs(wanted - tables) / (high - low)).sum())


def train_walk(training: Training, out: str | os.PathLike[str] = WALK_SKILL) -> WalkSkill:
    """Train walking and write the skill to ``out``."""
    start = np.concatenate([first_gains(), np.zeros((TABLES - 1) * len(GAINS))])
    problem = WalkProblem(walk_curriculum(training), start)
    training.prepare("walk", out, problem.curriculum)
    learned = training.learn(problem)
    training.demand_success("walk", problem, learned)
    skill = WalkSkill(walk_tables(learned)[0], FASTEST, training.made_by("walk"))
    skill.save(out)
    return skill
