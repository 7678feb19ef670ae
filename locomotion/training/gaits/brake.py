"""Training to brake from a run to a stand: changes of the run's parameters, gains of the walk's first steps,
and the moment of the change from one to the other."""

import math
import os
from dataclasses import dataclass
from typing import Any

import numpy as np

from locomotion.body.person import MASS
from locomotion.gaits.brake import BRAKE_SKILL, FIRST_STEPS, BrakeSkill
from locomotion.gaits.run import controller as c
from locomotion.gaits.run.skill import RunSkill, load_run_skill
from locomotion.gaits.slow_down import load_slow_down_skill
from locomotion.gaits.walk.layout import GAINS, LEVEL, gain_limits
from locomotion.gaits.walk.skill import load_walk_skill
from locomotion.human.human import BetweenGaits, Human
from locomotion.human.state import MOVING, HumanState
from locomotion.training.gaits.gait_state import gait_state
from locomotion.training.gaits.run_genes import row_scale
from locomotion.training.search.loop import Stage
from locomotion.training.training import Training

__all__ = [
    "BrakeProblem",
    "Stop",
    "brake_of",
    "draw_starts",
    "first_guess",
    "run_steadily",
    "stop",
    "train_brake",
]

_KNOTS, _MIDDLE = np.linspace(1.0, 4.0, 6), 2.4
_SIZE = sum(c.PARAMETERS.values())
_NUMBERS = {
    "deceleration": (3.5, 3.0, 8.0, 3.0),
    "reach": (0.5, 0.2, 0.9, 0.4),
    "hold": (0.03, 0.0, 0.14, 0.3),
}
"""First guess, least and greatest value, and scale of the skill's numbers."""
_WIDER = {
    "swing_time": (0.16, 0.5), "height": (0.65, 0.96), "lean": (-0.5, 0.3), "longest": (0.35, 1.0),
    "moment": (40.0, 300.0), "tilt_moment": (20.0, 250.0), "pressure_along": (0.01, 0.13),
    "height_damping": (2.0, 50.0), "height_stiffness": (10.0, 400.0), "pressure_rest": (-0.06, 0.1),
    "drop": (-0.2, 0.2), "clearance": (0.02, 0.25),
}  # fmt: skip
"""Least and greatest gains of a braking step, where they differ from a walk's."""
_KEPT = (
    "roughness", "steepness", "foot_pitch", "foot_roll", "ankle_spare", "foot_turn", "foot_hold",
    "height_slope", "height_uphill", "lean_slope", "climb_rate", "trim_rate", "most_trim",
)  # fmt: skip
"""Gains that have no effect here."""
_SHAPE = ("posture", "a_hat", "feed_forward", "timing")
_PLANTING = ("swing_hip_flexion", "stance_hip_flexion", "waist_pitch")
"""Actions that put the foot forward and the trunk back."""
_STARTS, _FASTEST, _SHARPEST = 400, 3.7, 8.0  # runs; [m/s]; [m] radius of their bends
_NOISE = np.repeat([0.1, 0.02], [6, 39])  # of a start's root velocities and joint angles
_LONGEST, _SETTLES = 300, 140  # ticks within which it should stand; then ticks in which it may fall
_TAKES = 2.5  # [s] of a trial, about
_STANDS = 0.1  # [m/s] along its way
_BACK = 0.2  # [m/s] of moving back that cost nothing
_HARD = 4.5  # body weights of ground reaction that cost nothing


@dataclass(frozen=True)
class Stop:
    """How a person stopped: whether it fell; whether it came to a stand; greatest distance [m] of its centre
    of mass from where it was told to, in its direction of motion; least speed in that direction [m/s];
    share of the time that it was up and not at rest; mean squared tilt of the pelvis; greatest ground
    reaction [body weights]; whether the walk took over; final error of its heading [rad].
    """

    fell: bool
    stood: bool
    way: float
    least: float
    up: float
    tilt: float
    peak: float
    walked: bool
    askew: float

    def cost(self, fall: float = 1.2) -> float:
        """The cost that training minimises. A ``fall`` costs about a metre: rehearsals will try variations,
        and take the shortest stop that stays up."""
        cost = 2.0 * self.way + 3.0 * self.tilt + 0.2 * max(self.peak - _HARD, 0.0)
        if not self.walked:
            return cost + 3.5 + 2.0 * (1.0 - self.up) + 0.7 * max(self.least, 0.0)
        if self.fell:
            return cost + fall + 1.5 * (1.0 - self.up) + 0.7 * max(self.least, 0.0)
        cost += self.up + self.askew
        return cost + 2.0 * max(-self.least - _BACK, 0.0) + (0.0 if self.stood else 0.5)


def run_steadily(rng: np.random.Generator, human: Human, speed: float, bend: float) -> HumanState | None:
    """A person in a steady run at a random moment, straight ahead or in a bend of curvature ``bend`` [1/m];
    None if it never got there."""
    heading = bend * 0.1 * np.maximum(np.arange(600) - 40, 0)
    points = np.zeros((601, 3))
    points[1:, 0], points[1:, 1] = 0.1 * np.cumsum(np.cos(heading)), 0.1 * np.cumsum(np.sin(heading))
    human.reset(points[0], 0.0, speed)
    noise = rng.normal(size=45) * _NOISE
    human.data.qvel[:6] += noise[:6]
    human.data.qpos[7:] += noise[6:]
    human.follow(points, speed)
    for _ in range(int(rng.integers(130, 400))):
        human.tick()
        if human.gait_now != "run" or human.status not in MOVING:
            return None
    return human.save_state()


def draw_starts(rng: np.random.Generator, count: int, speeds: tuple[float, float]) -> list[HumanState]:
    """People in steady runs of ``speeds`` [m/s], a third of them in bends."""
    human, starts = (
        Human(
            None,
            clearing=(),
            rehearsals=0,
            between=BetweenGaits(brake=brake_of(first_guess()), residual=None),
        ),
        [],
    )
    while len(starts) < count:
        speed = float(rng.uniform(*speeds))
        radius = max(_SHARPEST, speed * speed / 1.2) * float(rng.uniform(1.0, 2.0))
        bend = float(rng.choice([-1.0, 0.0, 0.0, 0.0, 0.0, 1.0])) / radius
        start = run_steadily(rng, human, speed, bend)
        starts += [] if start is None else [start]
    return starts


def stop(human: Human, start: HumanState, harder: float = 1.0) -> Stop:
    """Let ``human`` brake in the state ``start``, ``harder`` than its skill by that share."""
    human.restore_state(start)
    human.stop()
    human.brake(harder)
    state = human.control
    begun, velocity = human.com, human.velocity[:2]
    along = velocity / np.linalg.norm(velocity)
    way = tilt = peak = 0.0
    least, stood, walked, tick = math.inf, 0, False, 0
    while tick < _LONGEST and not human.held and human.status != "fallen" and stood <= _SETTLES:
        human.tick()
        tick += 1
        way = max(way, float(along @ (human.com - begun)[:2]))
        least = min(least, float(along @ state[c.COM_VELOCITY][:2]))
        stood += least < _STANDS
        walked |= human.gait_now == "walk"
        tilt += float(human.qpos[4:6] @ human.qpos[4:6])
        peak = max(peak, float(state[c.CONTACT].sum()) / (9.81 * MASS))
    fell = human.status == "fallen"
    askew = abs(math.remainder(human.yaw - gait_state(human)[c.HEADING], 2.0 * math.pi))
    return Stop(fell, stood > 0, way, least, tick / _LONGEST, tilt / max(tick, 1), peak, walked, askew)


def first_guess() -> np.ndarray:
    """First guess of the parameters: those of slowing down, with a reference speed that falls faster."""
    walk = load_walk_skill()
    slow_down = load_slow_down_skill()
    numbers = [first for first, *_ in _NUMBERS.values()]
    gains = [walk.tables[LEVEL] + (1.0 - step / 4.0) * slow_down.gains for step in range(FIRST_STEPS)]
    return np.concatenate([np.zeros(2 * _SIZE), *gains, numbers])


def brake_of(x: np.ndarray, meta: dict | None = None) -> BrakeSkill:
    """The skill of these parameters: changes to slowing down at `_MIDDLE`, and per m/s above; the gains of
    the walk's first steps; the skill's numbers."""
    slow_down = load_slow_down_skill()
    change = np.stack([np.interp(_KNOTS, slow_down.knots, each) for each in slow_down.change.T], axis=1)
    change += x[:_SIZE] + (_KNOTS - _MIDDLE)[:, None] * x[_SIZE : 2 * _SIZE]
    numbers = x[-len(_NUMBERS) :]
    limits = np.array([(low, high) for _, low, high, _ in _NUMBERS.values()]).T
    low, high = _limits()
    gains = np.clip(x[2 * _SIZE : -len(numbers)].reshape(FIRST_STEPS, -1), low, high)
    deceleration, reach, hold = np.clip(numbers, *limits).tolist()
    return BrakeSkill(_KNOTS, change, gains, deceleration, reach, hold, meta or {})


def _limits() -> tuple[np.ndarray, np.ndarray]:
    """Least and greatest gains of a braking step."""
    low, high = gain_limits()
    for name, (least, most) in _WIDER.items():
        low[list(GAINS).index(name)], high[list(GAINS).index(name)] = least, most
    return low, high


def _curriculum(training: Training) -> tuple[Stage, ...]:
    shape, posed, planting = row_scale(*_SHAPE), row_scale("a_hat"), row_scale("timing")
    placed = [c.parameter_slices()["a_hat"].start + c.ACTIONS.index(name) for name in _PLANTING]
    planting[placed] = posed[placed]
    throwing = planting + row_scale("feed_forward")
    low, high = _limits()
    gains = np.tile(np.where([name in _KEPT for name in GAINS], 0.0, high - low), FIRST_STEPS)
    first_gains = np.where(np.arange(len(gains)) < len(GAINS), gains, 0.0)
    numbers = np.array([scale for *_, scale in _NUMBERS.values()])
    first = np.concatenate([shape, np.zeros(_SIZE), gains, numbers])
    both = np.concatenate([shape, shape, gains, numbers])
    few = np.concatenate([throwing, planting, first_gains, numbers])

    def stage(
        name: str, generations: int, sigma: float, scale: np.ndarray, population: int = 24, **options: Any
    ) -> Stage:
        options = {"trials": 10, "harder": (1.0, 1.0), "ways": 1, "fall": 1.2} | options
        seconds = options["trials"] * options["ways"] * _TAKES
        return Stage(name, training.generations(generations), sigma, scale, options, population, seconds)

    return (
        stage("plant a foot", 60, 0.08, first),
        stage("at any speed", 90, 0.05, both),
        stage("harder", 100, 0.1, few, population=16, harder=(1.0, 2.0)),
        stage("rehearsed", 40, 0.06, few, trials=8, ways=3, harder=(0.9, 2.3), fall=2.4),
        stage("rehearsed more widely", 35, 0.06, both, trials=8, ways=4, harder=(0.9, 2.8), fall=2.4),
    )


@dataclass(frozen=True)
class BrakeProblem:
    """Training to brake for `locomotion.training.search.loop.learn`, from the run ``run`` and the moments
    ``starts``."""

    curriculum: tuple[Stage, ...]
    run: RunSkill
    starts: list[HumanState]

    def stages(self) -> tuple[Stage, ...]:
        """The curriculum."""
        return self.curriculum

    def start(self) -> np.ndarray:
        """The first guess."""
        return first_guess()

    def scenarios(
        self, stage: Stage, generation: int, rng: np.random.Generator
    ) -> list[tuple[HumanState, np.ndarray]]:
        """Moments of runs, and how hard to brake there, in each of the ways to try."""
        drawn = rng.choice(len(self.starts), stage.options["trials"], replace=False)
        (low, high), ways = stage.options["harder"], stage.options["ways"]
        return [(self.starts[k], rng.uniform(low, high, ways)) for k in drawn]

    def evaluate(
        self, stage: Stage, candidate: np.ndarray, scenarios: list[tuple[HumanState, np.ndarray]]
    ) -> tuple[float, float]:
        """Mean cost of the best ways, and share of the trials in which the person stayed up in these."""
        human = Human(
            None,
            self.run,
            clearing=(),
            rehearsals=0,
            between=BetweenGaits(brake=brake_of(candidate), residual=None),
        )
        costs, up = [], []
        for start, ways in scenarios:
            stops = [stop(human, start, float(harder)) for harder in ways]
            tried = [each.cost(stage.options["fall"]) for each in stops]
            costs.append(min(tried))
            up.append(not stops[int(np.argmin(tried))].fell)
        return float(np.mean(costs)), float(np.mean(up))


def train_brake(training: Training, out: str | os.PathLike[str] = BRAKE_SKILL) -> BrakeSkill:
    """Train braking from the built-in run and write the skill to ``out``."""
    run, stages = load_run_skill(), _curriculum(training)
    training.prepare("brake", out, stages, ("walk", "run", "slow-down"))
    starts = draw_starts(np.random.default_rng([training.seed, 1]), _STARTS, (2.0, _FASTEST))
    problem = BrakeProblem(stages, run, starts)
    learned = training.learn(problem)
    training.demand_success("brake", problem, learned)
    skill = brake_of(learned, training.made_by("brake"))
    skill.save(out)
    return skill
