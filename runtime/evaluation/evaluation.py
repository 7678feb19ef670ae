"""Trials of a learned skill from many starts: how often does it hold?

Clearing skills go through the test of "Terrain Runner" (section 6: default height, 30 to 100 m of run-up) and
through the same over their range of heights; all the way that a mission takes: path tracking, speed planner,
skill, a level made of triangles. Velocities at the start have noise of 0.02 m/s and rad/s.
"""

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import partial

import numpy as np

from locomotion import MOVING, Ground, Human
from locomotion.body.person import CONTROL_DT
from locomotion.gaits.run import controller
from locomotion.gaits.run.skill import load_run_skill
from locomotion.human.state import HumanState
from locomotion.rehearsal.choices import REHEARSALS
from locomotion.skills.description import load_described
from locomotion.skills.interface import ClearingSkill
from locomotion.skills.jump.kind import JUMP
from locomotion.skills.kind import SkillKind
from locomotion.skills.library import learned_skills
from locomotion.skills.registry import skill_kind
from locomotion.training.gaits.rollout import Scenario, Simulator, stays_up
from runtime.evaluation.courses import CourseRun, Push, held, make_course, run_course

__all__ = [
    "Attempt", "Trial", "brake_trials", "clearing_trials", "described_trials", "run_trials",
    "slow_down_trials", "speed_up_trials", "start_noise", "walk_trials",
]  # fmt: skip

WALL = 0.3
"""Thickness of a wall [m]."""
NOISE = 0.02
"""Standard deviation [m/s, rad/s] of the velocities at the start."""
TURN, SPEEDS, CYCLES = math.radians(6.0), (2.0, 5.0), 20
"""Greatest turn per step [rad], speeds [m/s] and cycles (two steps each) of the running plane."""
HARD_PUSH, PUSHED_SPEEDS = 300.0, ((2.0, 2.0), (3.5, 3.5), (5.0, 5.0), SPEEDS)
"""[N] on the chest from any side for `PUSH_TIME`, once a run; ranges [m/s] from which the speeds of these
runs are drawn: the last since a run may have weak spots between the others."""
RUN_LENGTH = 60.0
"""[m] of each run with `PUSH`."""
PUSH, PUSH_TIME, PUSH_EVERY = 200.0, 0.1, 5.0
"""[N], [s] and [s] between: pushes on the pelvis from any side."""
PUSHED_WITHIN = -10.0, 4.0
"""[m] from an obstacle's edge, between which somebody who clears it is pushed with `PUSH`."""
STOPPED_FROM, STOPS = (2.5, 3.0, 3.5), (1.5, 2.0, 2.5)
"""[m/s] asked for of those who are told to stop; [m] within which they may come to stand."""
_SLOWEST = 0.5
_FAST, _RUNS_ON = 3.1, 10.0  # [m/s] of a step to most obstacles; [m] that it must get


@dataclass(frozen=True)
class Attempt:
    """One trial: of which test, what was tried, how it ended, whether that is a success, figures to take the
    mean of, where it lies in the plane of what was tried, by the names of its axes, and whether it is only
    there to compare with."""

    test: str
    what: str
    status: str
    held: bool
    figures: dict[str, float] = field(default_factory=dict)
    at: dict[str, float] = field(default_factory=dict)
    compared: bool = False


Trial = Callable[[], Attempt]
"""A trial that is drawn but not made yet."""


def clearing_trials(kind: SkillKind, trials: int, seed: int) -> list[Trial]:
    """Three tests of ``trials`` each: the usual size from 30 to 100 m, evenly; sizes drawn from those of
    ``kind`` from 10 to 30 m; the same with a push from any side somewhere in `PUSHED_WITHIN`."""
    skills = [skill for skill in Human().clearing if skill.affordance == kind.affordance]
    return _evaluate(kind, kind.usual, kind.sizes, skills, None, trials, seed)


def described_trials(path: str, trials: int, seed: int) -> list[Trial]:
    """The same tests of a skill of one's own, described by a file: the middle of its sizes, and all of
    them."""
    run = load_run_skill()
    skill = load_described(path, run)
    low, high = skill.heights
    middle = round(0.5 * (low + high), 2)
    every = learned_skills(run, [path])
    kind = skill_kind(skill.affordance)
    return _evaluate(kind, middle, (low, high), [skill], every, trials, seed)


def _evaluate(
    kind: SkillKind,
    height: float,
    heights: tuple[float, float],
    skills: Sequence[ClearingSkill],
    clearing: Sequence[ClearingSkill] | None,
    trials: int,
    seed: int,
) -> list[Trial]:
    """``skills``: those for the kind; ``clearing``: all that the person has."""
    low, high = heights
    rng = np.random.default_rng(seed)
    drawn = [
        (round(float(h), 2), float(d))
        for h, d in zip(rng.uniform(low, high, trials), rng.uniform(10.0, 30.0, trials), strict=True)
    ]
    pushed = f"{low:g} to {high:g} m, pushed with {PUSH:.0f} N"
    tests = {
        f"{height:g} m, from 30 to 100 m": [(height, float(d)) for d in np.linspace(30.0, 100.0, trials)],
        f"{low:g} to {high:g} m": drawn,
        pushed: drawn,
    }

    def attempt(test: str, height: float, distance: float) -> Attempt:
        what = f"{height:.2f} m from {distance:.1f} m"
        at = {"run-up [m]": distance, f"{kind.obstacle.measure} [m]": height}
        if not any(each.heights[0] - 1e-9 <= height <= each.heights[1] + 1e-9 for each in skills):
            return Attempt(test, what, "not learned for this height", False, at=at)
        course = make_course([(kind.affordance, height, WALL)], [distance])
        push = _push_at(seed, distance) if test == pushed else None
        run = run_course(course, clearing, start_noise(seed, distance), push=push)
        return replace(_judged(test, what, kind, run), at=at)

    todo = [(test, *start) for test, starts in tests.items() for start in starts]
    return [partial(attempt, *each) for each in todo]


def start_noise(seed: int, distance: float) -> np.ndarray:
    """Of the velocities at the start, (45,) [m/s, rad/s]; always the same for a seed and a distance."""
    return NOISE * np.random.default_rng([seed, round(1000.0 * distance)]).normal(size=45)


def _push_at(seed: int, distance: float) -> Push:
    """The push on one who comes over an obstacle ``distance`` [m] from the start; always the same for a
    seed and a distance."""
    rng = np.random.default_rng([seed, round(1000.0 * distance), 1])
    side, at = rng.uniform(-math.pi, math.pi), distance + rng.uniform(*PUSHED_WITHIN)
    force = PUSH * np.array([math.cos(side), math.sin(side)])
    return Push(float(at), force, round(PUSH_TIME / CONTROL_DT))


def _judged(test: str, what: str, kind: SkillKind, run: CourseRun) -> Attempt:
    """What became of a course with one obstacle."""
    if not run.reports:
        return Attempt(test, what, run.ended, False)
    passage = run.reports[0]
    status, good = run.ended, held(kind.affordance, run)
    figures = {"peak reaction [body weights]": passage.peak}
    if kind.obstacle.crossing == "off":
        figures["touches with the head"] = float(passage.head > 0.0)
        status += f", head on the ground for {passage.head:.2f} s" * (passage.head > 0.0)
    else:
        figures["touches it"] = float(passage.touched)
        status += ", touched it" * passage.touched
    if kind.holds_on:
        figures["hand in the middle half"] = float(abs(passage.planted - 0.5) <= 0.25)
        status += ", without its hand" * (passage.held == 0.0)
    return Attempt(test, what, status, good, figures if good else {})


def run_trials(trials: int, seed: int) -> list[Trial]:
    """Tests of ``trials`` each: 20 cycles at a turn and a speed drawn from the plane of "Terrain Runner"
    (section 4.1); a push of 300 N from a random side at speeds of each of `PUSHED_SPEEDS`; straight runs of
    60 m with a push of 200 N every 5 s."""
    simulator = Simulator()
    tests: list[Callable[[np.random.Generator], Attempt]] = [partial(_run_turning, simulator)]
    tests += [partial(_pushed_hard, simulator, speeds) for speeds in PUSHED_SPEEDS]
    tests.append(_run_pushed)
    return [lambda t=t, k=k: t(np.random.default_rng([seed, k])) for t in tests for k in range(trials)]


def _run_turning(simulator: Simulator, rng: np.random.Generator) -> Attempt:
    """20 cycles; the first five do not count for the errors."""
    skill = load_run_skill()
    turn, speed = rng.uniform(-TURN, TURN), rng.uniform(*SPEEDS)
    a, b = skill.step_length
    steps_per_s = speed / (a * speed + b)
    scenario = Scenario(
        1.0 + 2 * CYCLES / steps_per_s, np.array([[0.0, speed]]),
        headings=np.array([[0.0, 0.0], [1.0, turn * steps_per_s]]),
    )  # fmt: skip
    seen: list[tuple[float, float, float]] = []

    def note(simulator: Simulator) -> None:
        state = simulator.state
        if state[controller.STEP_TIME] == 0.0 and state[controller.STEPS] > 10:
            vx, vy = state[controller.COM_VELOCITY][:2]
            way = math.atan2(vy, vx)
            seen.append((state[controller.STEP_SPEED], way, state[controller.TICKS]))

    survived = stays_up(simulator.run(skill, scenario, note), scenario.duration)
    figures = {}
    if survived and len(seen) > 1:
        steps = np.array(seen)
        made = np.diff(np.unwrap(steps[:, 1])).mean()
        figures = {
            "error in speed [m/s]": abs(steps[:, 0].mean() - speed),
            "error in turn [°/step]": math.degrees(abs(made - turn)),
        }
    what = f"{math.degrees(turn):+.1f} °/step at {speed:.2f} m/s"
    test = f"±6 °/step at 2 to 5 m/s, {CYCLES} cycles"
    at = {"speed [m/s]": speed, "turn [°/step]": math.degrees(turn)}
    return Attempt(test, what, "ran" if survived else "fell", survived, figures, at)


def _pushed_hard(simulator: Simulator, speeds: tuple[float, float], rng: np.random.Generator) -> Attempt:
    """A straight run at a speed drawn from ``speeds`` [m/s], pushed at any moment of its fourth second; it
    goes on for at least 5 s."""
    side, begin, speed = rng.uniform(-math.pi, math.pi), rng.uniform(3.0, 4.0), rng.uniform(*speeds)
    push = [begin, HARD_PUSH * math.cos(side), HARD_PUSH * math.sin(side), PUSH_TIME]
    scenario = Scenario(9.0, np.array([[0.0, speed]]), pushes=np.array([push]))
    survived = stays_up(simulator.run(load_run_skill(), scenario), scenario.duration)
    drawn_from = " to ".join(f"{each:g}" for each in dict.fromkeys(speeds))
    test = f"a push of {HARD_PUSH:.0f} N at {drawn_from} m/s"
    what = f"from {math.degrees(side):+.0f}° after {begin:.2f} s at {speed:.2f} m/s"
    return Attempt(test, what, "ran" if survived else "fell", survived)


def _run_pushed(rng: np.random.Generator) -> Attempt:
    human = Human(clearing=())  # just learned: nothing that clears obstacles is learned on it yet
    speed = float(rng.uniform(*human.on_feet.run_skill.speeds))
    yaw = float(rng.uniform(-math.pi, math.pi))
    path = np.outer([0.0, RUN_LENGTH], [math.cos(yaw), math.sin(yaw), 0.0])
    human.reset(path[0], yaw)
    human.follow(path, speed)
    for force in _pushes(rng):
        human.data.xfrc_applied[human.index.root, :2] = force
        human.tick()
        if human.status not in MOVING or human.time > RUN_LENGTH / _SLOWEST:
            break
    test = f"{RUN_LENGTH:.0f} m, pushes of {PUSH:.0f} N"
    return Attempt(test, f"{speed:.2f} m/s", human.status, human.status == "arrived")


def walk_trials(trials: int, seed: int) -> list[Trial]:
    """Winding paths, a test of ``trials`` for each kind of ground, with pushes of up to 80 N on the level."""
    from locomotion.training.gaits.path_trial import follow_path
    from locomotion.training.gaits.walk import KINDS, draw_walk

    def attempt(name: str, kind: dict, k: int) -> Attempt:
        scenario = draw_walk(np.random.default_rng([seed, k]), kind)
        figures = follow_path(scenario, rehearsals=REHEARSALS).figures
        arrived = figures["time"] >= scenario.duration
        what = f"{scenario.length:.1f} m at {scenario.speed:.2f} m/s"
        slower = {"slower than meant [m/s]": figures["behind"]}
        return Attempt(name, what, "arrived" if arrived else "did not arrive", arrived, slower)

    return [partial(attempt, name, kind, k) for name, kind in KINDS.items() for k in range(trials)]


def speed_up_trials(trials: int, seed: int) -> list[Trial]:
    """Starts from standing, with noise: does the person run up to a stair, and after how many metres was a
    step as fast as it takes for most obstacles?"""
    course = make_course([(JUMP.affordance, JUMP.usual, WALL)], [_RUNS_ON + 3.0])
    ground = Ground.from_arrays(course.vertices, course.faces)

    def attempt(k: int) -> Attempt:
        rng = np.random.default_rng([seed, k])
        human = Human(ground)
        human.reset(course.path[0], 0.0)
        human.data.qvel[:] += NOISE * rng.normal(size=human.model.nv)
        speed = float(rng.uniform(3.3, 3.8))
        human.follow(course.path, speed, course.obstacles)
        far = math.nan
        while human.status in MOVING and human.com[0] < _RUNS_ON:
            human.tick()
            if math.isnan(far) and human.control[controller.STEP_SPEED] >= _FAST:
                far = float(human.com[0])
        held = human.status in MOVING
        figures = {f"way to {_FAST:g} m/s [m]": far} if held and math.isfinite(far) else {}
        return Attempt("from standing", f"{speed:.2f} m/s", human.status, held, figures)

    return [partial(attempt, k) for k in range(trials)]


def slow_down_trials(trials: int, seed: int) -> list[Trial]:
    """Runs over straight ways, and over ways with bends, that end at a goal or are called off: does the
    person stand in the end?"""
    from locomotion.gaits.slow_down import load_slow_down_skill
    from locomotion.training.gaits.slow_down import BENDS, draw_halt, halt

    run, slow_down = load_run_skill(), load_slow_down_skill()

    def attempt(name: str, radii: tuple[float, ...], k: int) -> Attempt:
        trial = draw_halt(np.random.default_rng([seed, k]), radii)
        stood = halt(trial, run, slow_down, REHEARSALS)[1]
        what = f"{trial.speed:.2f} m/s, {'at its goal' if trial.told == math.inf else 'told to stop'}"
        return Attempt(name, what, "stands" if stood else "fallen", stood)

    ways = {"straight": (math.inf,), "bends": BENDS}
    return [partial(attempt, name, radii, k) for name, radii in ways.items() for k in range(trials)]


def brake_trials(trials: int, seed: int) -> list[Trial]:
    """People in steady runs, straight on or in a bend, who are told to stop at a random moment: do they stand
    in the end, and how far does the centre of mass come in the direction in which it moved then, from there
    and from the next touchdown on?"""
    from locomotion.training.gaits.brake import draw_starts

    human = Human(clearing=())

    def attempt(speed: float, start: HumanState) -> Attempt:
        human.restore_state(start)
        begun, velocity = human.com, human.velocity
        along, way, before = velocity / np.linalg.norm(velocity), 0.0, math.nan
        human.stop()
        while not human.held:
            human.tick()
            way = max(way, float(along @ (human.com - begun)))
            if math.isnan(before) and human.control[controller.STEP_TIME] == 0.0:
                before = way
        stands = human.status == "standing"
        figures = {"way [m]": way} | {f"share within {far:g} m": float(way <= far) for far in STOPS}
        if math.isfinite(before):
            figures |= {"from the next touchdown [m]": way - before}
            figures |= {f"share within {STOPS[0]:g} m of it": float(way - before <= STOPS[0])}
        test = f"told at {speed:g} m/s"
        return Attempt(test, f"{way:.2f} m", human.status, stands, figures if stands else {})

    return [
        partial(attempt, speed, start)
        for speed in STOPPED_FROM
        for start in draw_starts(np.random.default_rng([seed, round(10 * speed)]), trials, (speed, speed))
    ]


def _pushes(rng: np.random.Generator) -> Iterator[np.ndarray]:
    """Horizontal force (2,) [N] of each tick."""
    ticks, length = round(PUSH_EVERY / CONTROL_DT), round(PUSH_TIME / CONTROL_DT)
    while True:
        begin = int(rng.integers(ticks // 2, ticks - length))
        side = rng.uniform(-math.pi, math.pi)
        force = PUSH * np.array([math.cos(side), math.sin(side)])
        for tick in range(ticks):
            yield force if begin <= tick < begin + length else np.zeros(2)
