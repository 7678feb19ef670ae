"""Learning to speed up from a walk to a run: what changes of the run's parameters while it does."""

import os
from dataclasses import dataclass

import numpy as np

from locomotion.gaits.run import controller as c
from locomotion.gaits.run.skill import RunSkill, load_run_skill
from locomotion.gaits.speed_up import SPEED_UP_SKILL, SpeedUpSkill
from locomotion.human.human import BetweenGaits, Human
from locomotion.human.state import MOVING
from locomotion.training.gaits.run_genes import row_scale
from locomotion.training.gaits.walk_starts import WALK_STARTS, WalkStart, walk_starts
from locomotion.training.search.loop import Stage
from locomotion.training.training import Training

__all__ = ["SpeedUpProblem", "speed_up", "speed_up_of", "train_speed_up"]

_KNOTS = np.array([1.8, 3.2])
_SIZE = sum(c.PARAMETERS.values())
_WANTED, _TOO_FAST = 3.3, 3.8  # [m/s]
_LENGTH = 8.0  # [m] in which it should be as fast
_AFTERWARDS = 150  # ticks that it must go on from there
_FREE = ("posture", "a_hat", "feed_forward", "timing", "m_ap", "m_sp")


def speed_up(human: Human, start: WalkStart, noise: np.ndarray) -> tuple[float, bool]:
    """Cost of a trial, and whether the person ran on: what it lacks of the wanted speed, over the first
    `_LENGTH` m [m²/s]."""
    human.restore_state(start.state)
    human.run(True, start.speed)
    human.data.qvel[:] += noise
    begun, state = human.com[0], human.control
    lacks, at, late = 0.0, 0.0, 0
    while late < _AFTERWARDS:
        human.tick()
        now, speed = human.com[0] - begun, float(state[c.COM_VELOCITY][0])
        if human.status not in MOVING:
            return 10.0 + 10.0 * (1.0 - min(now / (2.0 * _LENGTH), 1.0)) + lacks / _LENGTH, False
        if at < _LENGTH:
            off = max(_WANTED - speed, 0.0) + max(speed - _TOO_FAST, 0.0)
            lacks, at = lacks + max(now - at, 0.0) * off, now
        else:
            late += 1
    return lacks, True


def speed_up_of(x: np.ndarray, meta: dict | None = None) -> SpeedUpSkill:
    """The skill that parameters stand for: what is added at the lower speed, and what is added to that at the
    higher one."""
    return SpeedUpSkill(_KNOTS, np.stack([x[:_SIZE], x[:_SIZE] + x[_SIZE:]]), meta or {})


def _curriculum(training: Training) -> tuple[Stage, ...]:
    scale = row_scale(*_FREE)
    scale = np.concatenate([scale, 0.5 * scale])
    return (Stage("speed up", training.generations(120), 0.06, scale, {"trials": 6}, population=20),)


@dataclass(frozen=True)
class SpeedUpProblem:
    """Learning to speed up for `locomotion.training.search.loop.learn`, to the run ``run``."""

    curriculum: tuple[Stage, ...]
    run: RunSkill

    def stages(self) -> tuple[Stage, ...]:
        """The curriculum."""
        return self.curriculum

    def start(self) -> np.ndarray:
        """The first guess: the run as it is."""
        return np.zeros(2 * _SIZE)

    def scenarios(
        self, stage: Stage, generation: int, rng: np.random.Generator
    ) -> list[tuple[int, np.ndarray]]:
        """Random trials: which start, and noise of its velocities (45,) [m/s, rad/s]."""
        count = stage.options["trials"]
        return [(int(rng.integers(WALK_STARTS)), 0.05 * rng.normal(size=45)) for _ in range(count)]

    def evaluate(
        self, stage: Stage, candidate: np.ndarray, scenarios: list[tuple[int, np.ndarray]]
    ) -> tuple[float, float]:
        """Mean cost, and share of the trials in which the person ran on."""
        human = Human(
            None, self.run, clearing=(), rehearsals=0, between=BetweenGaits(speed_up=speed_up_of(candidate))
        )
        results = [speed_up(human, walk_starts()[number], noise) for number, noise in scenarios]
        return float(np.mean([cost for cost, _ in results])), float(np.mean([ran for _, ran in results]))


def train_speed_up(training: Training, out: str | os.PathLike[str] = SPEED_UP_SKILL) -> SpeedUpSkill:
    """Learn to speed up to the package's run and write the skill to ``out``."""
    problem = SpeedUpProblem(_curriculum(training), load_run_skill())
    training.prepare("speed-up", out, problem.curriculum, ("walk", "run"))
    learned = training.learn(problem)
    training.demand_success("speed-up", problem, learned)
    skill = speed_up_of(learned, training.made_by("speed-up"))
    skill.save(out)
    return skill
