"""Training to slow down from a run to a walk: changes of the run's parameters at low speeds, and of the
walk's gains in its first steps."""

import math
import os
from dataclasses import dataclass

import numpy as np

from locomotion.gaits.run import controller as c
from locomotion.gaits.run.skill import RunSkill, load_run_skill
from locomotion.gaits.slow_down import SLOW_DOWN_SKILL, SlowDownSkill, touchdown
from locomotion.gaits.walk.layout import GAINS, gain_limits
from locomotion.human.human import BetweenGaits, Human
from locomotion.training.gaits.path_trial import draw_path
from locomotion.training.gaits.run_genes import row_scale
from locomotion.training.search.loop import Stage
from locomotion.training.training import Training

__all__ = [
    "BENDS",
    "Halt",
    "SlowDownProblem",
    "draw_halt",
    "first_guess",
    "halt",
    "slow_down_of",
    "train_slow_down",
]

BENDS = (6.0, 10.0, 100.0)
"""Radii [m] of the bends in the paths."""
_KNOTS = np.array([1.2, 2.0, 2.8])
_SIZE = sum(c.PARAMETERS.values())
_LATE, _SETTLES = 250, 350  # ticks within which it should have slowed down; in which it should stand then
_INSIDE = (0.02, 0.15)  # [m] inside of a landing foot at which the capture point should be
_SIDEWAYS = 1.2  # [m/s^2] in bends at most
_FREE = ("posture", "a_hat", "feed_forward", "timing")


@dataclass(frozen=True)
class Halt:
    """One trial: a person that runs along ``points`` (n, 3) [m] at ``speed`` [m/s] stops at their end, or at
    the tick ``told``. noise (45,): added to the start's root velocities and joint angles."""

    points: np.ndarray
    speed: float
    told: float
    noise: np.ndarray


def draw_halt(rng: np.random.Generator, radii: tuple[float, ...] = BENDS) -> Halt:
    """A random trial on a path with bends of one of ``radii`` [m]."""
    speed = float(rng.uniform(2.5, 3.8))
    radius = max(float(rng.choice(radii)), speed**2 / _SIDEWAYS)
    path = draw_path(rng, (11.0, 15.0), (speed, speed), radius)
    told = math.inf if rng.random() < 0.7 else float(rng.integers(60, 200))
    return Halt(path.points, path.speed, told, rng.normal(size=45) * np.repeat([0.1, 0.02], [6, 39]))


def halt(trial: Halt, run: RunSkill, slow_down: SlowDownSkill, rehearsals: int = 0) -> tuple[float, bool]:
    """Cost of a trial, and whether the person stood at the end. rehearsals: as for `Human`."""
    human = Human(None, run, clearing=(), between=BetweenGaits(slow_down=slow_down), rehearsals=rehearsals)
    x, y, _ = trial.points[1] - trial.points[0]
    human.reset(trial.points[0], math.atan2(y, x), trial.speed)
    human.data.qvel[:6] += trial.noise[:6]
    human.data.qpos[7:] += trial.noise[6:]
    human.follow(trial.points, trial.speed)
    slow, walked, told, begun, state = 0, 0, trial.told, human.com, human.control
    crossed, pace, far, tilt = [], trial.speed, 0.0, 0.0
    while not human.held and human.status != "fallen" and slow < 2 * _LATE:
        told -= 1
        if told == 0:
            human.stop()
        human.tick()
        if human.gait_now == "walk":
            walked += 1
            tilt += 2.0 * float(human.qpos[4:6] @ human.qpos[4:6])  # 1 minus the cosine of the pelvis' tilt
        elif human.gait_now == "slow run":
            slow += 1
            begun = human.com if slow == 1 else begun
            far = float(np.linalg.norm(human.com - begun))
            if state[c.STEP_TIME] == 0.0:
                _, inside, pace = touchdown(state)
                crossed.append(max(_INSIDE[0] - inside, inside - _INSIDE[1], 0.0))
    fell = human.status == "fallen"
    cost = 15.0 * float(np.mean(crossed)) if crossed else 0.5
    if not walked:
        return cost + (12.0 + 4.0 * max(1.0 - slow / _LATE, 0.0) if fell else 9.0 + 2.0 * pace), False
    cost += 0.5 * pace + 0.25 * far + 5.0 * tilt / walked
    return cost + (2.0 + 5.0 * max(1.0 - walked / _SETTLES, 0.0) if fell else 0.0), not fell


def first_guess() -> np.ndarray:
    """First guess of the parameters: changes to the run at 2 m/s and below, further changes at 1.2 m/s, and
    changes to the walk's gains: legs farther apart, trunk farther back."""
    x = np.zeros(2 * _SIZE + len(GAINS))
    a_hat = c.parameter_slices()["a_hat"].start
    x[a_hat + c.ACTIONS.index("swing_hip_abduction")] = 0.1
    x[a_hat + c.ACTIONS.index("waist_pitch")] = -0.1
    return x


def slow_down_of(x: np.ndarray, meta: dict | None = None) -> SlowDownSkill:
    """The skill of these parameters, see `first_guess`."""
    low, lowest, gains = x[:_SIZE], x[_SIZE : 2 * _SIZE], x[2 * _SIZE :]
    return SlowDownSkill(_KNOTS, np.stack([low + lowest, low, np.zeros(_SIZE)]), gains, meta or {})


def _curriculum(training: Training) -> tuple[Stage, ...]:
    low, lowest = row_scale(*_FREE, "m_ap", "m_sp"), row_scale(*_FREE)
    least, most = gain_limits()
    scale = np.concatenate([low, lowest, most - least])
    return (Stage("slow down", training.generations(40), 0.08, scale, {"trials": 10}, population=24),)


@dataclass(frozen=True)
class SlowDownProblem:
    """Training to slow down for `locomotion.training.search.loop.learn`, from the run ``run``."""

    curriculum: tuple[Stage, ...]
    run: RunSkill

    def stages(self) -> tuple[Stage, ...]:
        """The curriculum."""
        return self.curriculum

    def start(self) -> np.ndarray:
        """The first guess."""
        return first_guess()

    def scenarios(self, stage: Stage, generation: int, rng: np.random.Generator) -> list[Halt]:
        """Random trials."""
        return [draw_halt(rng) for _ in range(stage.options["trials"])]

    def evaluate(self, stage: Stage, candidate: np.ndarray, scenarios: list[Halt]) -> tuple[float, float]:
        """Mean cost, and share of the trials in which the person stood in the end."""
        skill = slow_down_of(candidate)
        results = [halt(trial, self.run, skill) for trial in scenarios]
        return float(np.mean([cost for cost, _ in results])), float(np.mean([stood for _, stood in results]))


def train_slow_down(training: Training, out: str | os.PathLike[str] = SLOW_DOWN_SKILL) -> SlowDownSkill:
    """Train slowing down from the built-in run and write the skill to ``out``."""
    problem = SlowDownProblem(_curriculum(training), load_run_skill())
    training.prepare("slow-down", out, problem.curriculum, ("walk", "run"))
    learned = training.learn(problem)
    training.demand_success("slow-down", problem, learned)
    skill = slow_down_of(learned, training.made_by("slow-down"))
    skill.save(out)
    return skill
