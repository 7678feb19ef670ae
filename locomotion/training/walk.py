"""Learning to walk: the gains of the walking controller, from a first guess on level ground to rough
ground."""

import os
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from locomotion.training.loop import Progress, Stage, learn
from locomotion.training.path_trial import PathScenario, draw_path, follow_path
from locomotion.walk_layout import GAINS, first_gains, gain_limits
from locomotion.walk_skill import WALK_SKILL, WalkSkill

__all__ = ["WalkProblem", "train_walk", "walk_curriculum"]

SPEED = 1.25
"""Fastest walk [m/s]."""
_STEPS_PER_S = 1.9  # of people who walk at 1.3 m/s; it grows with the root of the speed
_UNIT = 0.08  # share of a gain's range that is one unit of the search


def _kind(ground: str, speeds: tuple[float, float], radius: float, **options: Any) -> dict[str, Any]:
    length = (9.0, 15.0) if ground == "ramps" else (4.0, 9.0)
    return {"ground": ground, "speeds": speeds, "radius": radius, "length": length, **options}


def walk_curriculum(effort: float = 1.0) -> tuple[Stage, ...]:
    """From level ground to ramps and moguls; ``effort`` scales the number of generations."""
    level, rolling = _kind("level", (0.6, 1.25), 0.8), _kind("rolling", (0.6, 1.25), 1.0)
    ramps, moguls = _kind("ramps", (0.8, 1.25), 1.2), _kind("moguls", (0.4, 0.8), 1.0)
    pushed = _kind("level", (0.6, 1.25), 1.0, push=80.0)
    low, high = gain_limits()

    def stage(name: str, generations: int, sigma: float, *kinds: dict[str, Any]) -> Stage:
        rounds = max(round(generations * effort), 1)
        return Stage(name, rounds, sigma, _UNIT * (high - low), {"kinds": kinds}, population=16)

    return (
        stage("level", 20, 1.0, level, level, level, rolling),
        stage("rolling", 30, 0.6, level, rolling, rolling, rolling, ramps),
        stage("ramps", 40, 0.5, pushed, rolling, ramps, ramps, ramps, moguls),
        stage("moguls", 40, 0.4, pushed, rolling, ramps, ramps, moguls, moguls),
    )


@dataclass(frozen=True)
class WalkProblem:
    """Learning of the walk for `locomotion.training.loop.learn`: its stages and the first guess of the
    gains."""

    curriculum: tuple[Stage, ...]
    gains: np.ndarray

    def stages(self) -> tuple[Stage, ...]:
        """The curriculum."""
        return self.curriculum

    def start(self) -> np.ndarray:
        """The first guess."""
        return self.gains

    def scenarios(self, stage: Stage, generation: int, rng: np.random.Generator) -> list[PathScenario]:
        """One random path of each of the stage's kinds."""
        return [draw_path(rng, **kind) for kind in stage.options["kinds"]]

    def evaluate(
        self, stage: Stage, candidate: np.ndarray, scenarios: list[PathScenario]
    ) -> tuple[float, float]:
        """Mean cost and mean share of the way covered; gains outside their limits cost and are cut."""
        low, high = gain_limits()
        outside = np.maximum(low - candidate, 0.0) + np.maximum(candidate - high, 0.0)
        walk = WalkSkill(np.clip(candidate, low, high), SPEED)
        cost, covered = 4.0 * float((outside / (high - low)).sum()), 0.0
        for scenario in scenarios:
            f = follow_path(scenario, walk=walk).figures
            done = f["time"] / scenario.duration
            pace = _STEPS_PER_S * np.sqrt(max(f["speed"], 0.2) / 1.3)
            looks = (
                0.3 * abs(f["step_rate"] - pace) + 3.0 * f["trunk"] + 0.02 * f["effort"] + 0.05 * f["head"]
            )
            cost += (10.0 * (1.0 - done) + 2.0 * (done < 1.0) + 1.5 * f["side_drift"] + looks) / len(
                scenarios
            )
            covered += done / len(scenarios)
        return cost, covered


def train_walk(
    out: str | os.PathLike[str] = WALK_SKILL,
    seed: int = 0,
    checkpoint: str | os.PathLike[str] | None = None,
    workers: int = 2,
    effort: float = 1.0,
    on_progress: Callable[[Progress], None] | None = None,
) -> WalkSkill:
    """Learn to walk and write the skill to ``out``; arguments as for `locomotion.training.run.train_run`."""
    problem = WalkProblem(walk_curriculum(effort), first_gains())
    learned = learn(problem, seed, checkpoint, workers, on_progress)
    assert learned is not None and len(learned) == len(GAINS)
    meta = {"made by": "surefoot train walk", "seed": seed, "effort": effort}
    skill = WalkSkill(np.clip(learned, *gain_limits()), SPEED, meta)
    skill.save(out)
    return skill
