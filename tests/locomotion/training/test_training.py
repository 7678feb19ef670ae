"""Learning: the optimiser, resuming, the same result for the same seed. Nothing is really learned here."""

import itertools
from collections import Counter
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from locomotion.body.person import MASS
from locomotion.errors import LocomotionError
from locomotion.gaits.run.layout import COM_VELOCITY, CONTACT, SPEED, STEP_TIME, parameter_slices
from locomotion.gaits.run.skill import load_run_skill
from locomotion.human.human import Human
from locomotion.human.state import MOVING
from locomotion.training.gaits.grounds import training_ground
from locomotion.training.gaits.path_trial import PathScenario, draw_path
from locomotion.training.gaits.rollout import FIGURES, Scenario, Simulator, Trial, stays_up
from locomotion.training.gaits.run import RunProblem, begin
from locomotion.training.gaits.run_curriculum import WAYS
from locomotion.training.gaits.run_genes import (
    BLOCKS,
    SIZE,
    first_guess,
    first_state_reference,
    genes_scale,
    inner_scale,
    rows_scale,
    skill_of,
)
from locomotion.training.gaits.run_trials import TrialKind, cost, draw_scenario
from locomotion.training.gaits.walk import KINDS as WALKS
from locomotion.training.gaits.walk import draw_walk
from locomotion.training.progress import Clock
from locomotion.training.search.cma_es import CmaEs
from locomotion.training.search.loop import Stage, learn, simulated
from locomotion.training.training import Training


def minimise(function, start: np.ndarray, generations: int, sigma: float = 0.5) -> CmaEs:
    search = CmaEs(start, sigma, np.ones(len(start)), population=16)
    for generation in range(generations):
        asked = search.ask(np.random.default_rng(generation))
        search.tell(asked, np.array([function(x) for x in asked]))
    return search


def test_cma_finds_the_bottom_of_a_turned_valley() -> None:
    rng = np.random.default_rng(0)
    turn, _ = np.linalg.qr(rng.normal(size=(8, 8)))
    weights = np.logspace(0, 4, 8)

    def valley(x: np.ndarray) -> float:
        return float(np.sum(weights * (turn @ (x - 1.0)) ** 2))

    assert valley(minimise(valley, np.zeros(8), 300).best_guess) < 1e-8


def test_cma_keeps_up_with_the_cma_package() -> None:
    cma = pytest.importorskip("cma")

    def rosenbrock(x: np.ndarray) -> float:
        return float(np.sum(100 * (x[1:] - x[:-1] ** 2) ** 2 + (1 - x[:-1]) ** 2))

    mine = rosenbrock(minimise(rosenbrock, np.zeros(5), 250, 0.3).best_guess)
    options = {
        "popsize": 16,
        "seed": 1,
        "verbose": -9,
        "maxiter": 250,
        "tolfun": 0,
        "tolx": 0,
        "tolfunhist": 0,
    }
    theirs = cma.fmin2(rosenbrock, np.zeros(5), 0.3, options)[1].result.fbest
    assert mine < max(1e-6, 1e3 * theirs)


def tiny_problem() -> RunProblem:
    trial = {"duration": 0.2, "noise": 0.2}
    options = {"trials": 1, "style": 0.3, "fall": 0.0, "soft": 0.0, "kinds": ({},), "trial": trial}
    scale = genes_scale(1, 0, 0, "m_ap", "m_sp", "a_hat")
    stages = tuple(Stage(name, 2, 0.1, scale, options, population=4) for name in ("a", "b"))
    return RunProblem(stages, first_guess(), first_state_reference())


class Bowl:
    """The way to 1 in each of two parameters, seen askew in each trial."""

    def __init__(self, trials: int, askew: float, least: int = 1) -> None:
        self.trials, self.askew, self.least, self.judged = trials, askew, least, []

    def stages(self) -> list[Stage]:
        return [Stage("bowl", 60, 0.5, np.ones(2), population=8, least=self.least)]

    def start(self) -> np.ndarray:
        return np.zeros(2)

    def scenarios(self, stage: Stage, generation: int, rng: np.random.Generator) -> list:
        return list(self.askew * rng.normal(size=(self.trials, 2)))

    def evaluate(self, stage: Stage, candidate: np.ndarray, scenarios: list) -> tuple[float, float]:
        self.judged.append(len(scenarios))
        return float(np.mean([np.sum((candidate - 1.0 - askew) ** 2) for askew in scenarios])), 1.0


@pytest.mark.parametrize(
    ("trials", "least", "each"),
    [
        (1, 1, [1] * 8),
        (2, 1, [1] * 12),
        (5, 1, [2] * 8 + [3] * 4),
        (5, 3, [3] * 8 + [2] * 4),
        (2, 3, [2] * 8),
    ],
)
def test_only_the_better_half_of_a_generation_is_judged_on_all_trials(
    trials: int, least: int, each: list[int]
) -> None:
    problem = Bowl(trials, 0.1, least)
    learned = learn(problem, seed=3, workers=1, on_progress=lambda progress: None)
    assert problem.judged == each * 60
    np.testing.assert_allclose(learned, 1.0, atol=0.15)


def test_where_all_trials_are_alike_it_learns_as_if_candidates_did_not_race() -> None:
    learned = learn(Bowl(4, 0.0), seed=3, workers=1, on_progress=lambda progress: None)
    search = CmaEs(np.zeros(2), 0.5, np.ones(2), population=8)
    for generation in range(60):
        asked = search.ask(np.random.default_rng([3, 0, generation]))
        search.tell(asked, np.sum((asked - 1.0) ** 2, axis=1))
    np.testing.assert_array_equal(learned, search.best_guess)


def test_interrupted_and_resumed_equals_uninterrupted(tmp_path: Path) -> None:
    def silent(progress) -> None:
        assert progress.remaining >= 0.0

    whole = learn(tiny_problem(), seed=5, workers=1, on_progress=silent)
    checkpoint = tmp_path / "run.ckpt"
    assert learn(tiny_problem(), 5, checkpoint, workers=2, on_progress=silent, stop_after=3) is None
    resumed = learn(tiny_problem(), 5, checkpoint, workers=1, on_progress=silent)
    assert whole is not None and resumed is not None
    np.testing.assert_array_equal(whole, resumed)
    with pytest.raises(LocomotionError, match="another training or seed"):
        learn(tiny_problem(), 6, checkpoint, workers=1)
    checkpoint.write_bytes(checkpoint.read_bytes()[:200])
    with pytest.raises(LocomotionError, match="cut off or damaged"):
        learn(tiny_problem(), 5, checkpoint, workers=1)


def test_the_time_left_is_that_of_all_searches_and_not_of_what_was_done_before(monkeypatch, tmp_path) -> None:
    now = [0.0]
    monkeypatch.setattr("locomotion.training.progress.time", SimpleNamespace(monotonic=lambda: now[0]))
    stages = [Stage("a", 3, 1.0, np.ones(2), population=4, seconds=2.0), Stage("b", 1, 1.0, np.ones(2))]
    assert simulated(stages) == 3 * 4 * 2.0 + 32 * 1.0
    clock = Clock(simulated(stages))
    clock.skip(8.0)  # a generation of the first
    now[0] = 4.0
    assert clock.advance(8.0) == (4.0, pytest.approx(0.5 * (8.0 + 32.0)))
    told: list[float] = []
    learn(tiny_problem(), 5, tmp_path / "kept", 1, lambda p: told.append(p.remaining), Clock(100.0), 3)
    assert told == pytest.approx([0.0] * 3)  # no time goes by on this clock
    clock = Clock(100.0)
    learn(tiny_problem(), 5, tmp_path / "kept", 1, lambda p: None, clock)
    assert clock.ahead == pytest.approx(100.0 - simulated(tiny_problem().stages()))


def ticks_by_gait(path: PathScenario) -> Counter:
    """How many ticks people go along a path by each gait."""
    human, points = Human(training_ground(path.ground), clearing=(), rehearsals=0), path.points
    human.reset(points[0], float(np.arctan2(*(points[1] - points[0])[[1, 0]])))
    human.follow(points, path.speed)
    gaits: Counter = Counter()
    while human.status in MOVING and human.arc_length < path.length:
        human.tick()
        gaits[human.status] += 1
    return gaits


def test_paths_on_which_people_learn_to_run_are_run() -> None:
    ways = [kind for kind in WAYS if "length" in kind]
    gaits = sum((ticks_by_gait(draw_path(np.random.default_rng(3), **kind)) for kind in ways), Counter())
    assert set(gaits) == {"walking", "running"}
    assert gaits["running"] > 0.6 * gaits.total()  # the first steps are walked


@pytest.mark.parametrize("kind", WALKS)
def test_paths_on_which_people_learn_to_walk_are_walked(kind: str) -> None:
    path = draw_walk(np.random.default_rng(3), WALKS[kind])
    assert set(ticks_by_gait(path)) - {"arrived"} == {"walking"}


def test_rows_of_their_own_begin_as_their_neighbours_and_are_learned_without_slopes() -> None:
    genes = np.random.default_rng(0).normal(size=len(BLOCKS) * SIZE)
    genes[3 * SIZE :] = 0.0
    before = skill_of(genes, first_state_reference())
    rows = dict(zip(before.knots, before.table, strict=True))
    for row, neighbour in ((1.2, 2.5), (2.0, 2.5), (4.5, 4.0), (5.0, 4.0)):
        np.testing.assert_array_equal(rows[row], rows[neighbour])
    part = parameter_slices()
    beyond: dict[str, list[float]] = {
        "slow": [1.2, 2.0],
        "slowest": [1.2],
        "faster": [4.5, 5.0],
        "fastest": [5.0],
        "fast": [4.0],
    }
    for name, moved in beyond.items():
        after = skill_of(genes + rows_scale(**{name: 1.0}), first_state_reference()).table
        changed = (after[:, part["m_ap"]] != before.table[:, part["m_ap"]]).all(axis=1)
        assert list(before.knots[changed]) == moved
        np.testing.assert_array_equal(after[~changed], before.table[~changed])
        np.testing.assert_array_equal(after[:, part["climb"]], before.table[:, part["climb"]])


def test_rows_in_the_middle_change_alike_and_leave_the_others_as_they_are() -> None:
    genes = np.random.default_rng(0).normal(size=len(BLOCKS) * SIZE)
    before = skill_of(genes, first_state_reference())
    after = skill_of(genes + inner_scale("m_ap"), first_state_reference()).table
    moved = np.zeros_like(after)
    moved[:, parameter_slices()["m_ap"]] = np.reshape([0, 0, 0.4, 1, 1, 1, 0.4, 0], (-1, 1))
    np.testing.assert_allclose(after, before.table + moved, atol=1e-12)


def test_what_a_stage_does_not_feel_stays_as_it_is() -> None:
    """Genes that make no difference would wander off."""
    free = genes_scale(1.0, 0.5, 2.0, "posture", "turn").reshape(len(BLOCKS), SIZE) > 0.0
    part = parameter_slices()
    for block, names in ((0, ("posture", "turn")), (1, ("posture", "turn")), (2, ("turn",))):
        assert free[block].sum() == sum(free[block, part[name]].sum() for name in names)
        assert all(free[block, part[name]].all() for name in names)
    assert not free[3:].any()


def test_running_goes_on_from_the_best_of_several_beginnings(tmp_path: Path) -> None:
    problem = tiny_problem()
    training = Training(7, tmp_path, workers=1, on_progress=lambda progress: None)
    genes = begin(training, problem.stages(), Clock(1.0), count=3)
    each = [learn(problem, 7 + k, None, 1, lambda progress: None) for k in range(3)]
    trials = [
        draw_scenario(np.random.default_rng(k), TrialKind(**problem.stages()[-1].options["trial"]))
        for k in range(9)
    ]
    costs = [problem.evaluate(problem.stages()[-1], x, trials)[0] for x in each]
    assert any(np.array_equal(genes, x) for x in each)
    np.testing.assert_array_equal(genes, each[int(np.argmin(costs))])
    np.testing.assert_array_equal(begin(training, problem.stages(), Clock(1.0), count=3), genes)


def test_trials_of_setting_off_begin_in_a_walk_from_which_people_run() -> None:
    scenario = draw_scenario(np.random.default_rng(2), TrialKind(3.0, speeds=(3.2, 3.2), walking=1.0))
    simulator, skill = Simulator(), load_run_skill()
    simulator.start(skill, scenario)
    walked, (pace, *_) = simulator.state[SPEED], simulator.state[COM_VELOCITY]
    assert 1.0 < walked < 1.5 and pace == pytest.approx(walked, abs=0.1)
    assert stays_up(simulator.run(skill, scenario), scenario.duration)
    assert simulator.state[COM_VELOCITY][0] > 2.5


def test_fewer_physics_steps_a_tick_simulate_as_long_a_run() -> None:
    skill, scenario = load_run_skill(), Scenario(2.0, np.array([[0.0, 3.5]]))
    simulators = Simulator(), Simulator(3)
    runs = [simulator.run(skill, scenario) for simulator in simulators]
    assert [simulator.data.time for simulator in simulators] == pytest.approx([2.0, 2.0])
    assert runs[0].figures["speed"] == pytest.approx(runs[1].figures["speed"], abs=0.1)
    assert not np.array_equal(runs[0].state, runs[1].state)


def test_trials_of_circles_turn_sharply_one_way_and_blows_are_hard() -> None:
    drawn = [
        draw_scenario(np.random.default_rng(k), TrialKind(9.0, (4.0, 4.0), lateral=1.6, circle=True))
        for k in range(99)
    ]
    turns = np.array([trial.headings[:, 1] for trial in drawn])
    assert np.all(turns == turns[:, :1])
    assert np.all(np.abs(4.0 * turns) >= 0.6 * 1.6 - 1e-12) and np.all(np.abs(4.0 * turns) <= 1.6 + 1e-12)
    assert 30 < np.sum(turns[:, 0] > 0.0) < 70
    blows = [
        draw_scenario(np.random.default_rng(k), TrialKind(9.0, push=330.0, weakest=0.8)) for k in range(99)
    ]
    force = np.concatenate([np.hypot(*trial.pushes[:, 1:3].T) for trial in blows])
    assert force.min() >= 0.8 * 330.0 - 1e-9 and force.max() <= 330.0 + 1e-9


def test_a_fall_costs_what_its_stage_says_and_a_trial_that_lasts_nothing() -> None:
    problem, rng = tiny_problem(), np.random.default_rng(2)
    lasts, falls = draw_scenario(rng, TrialKind(0.2)), draw_scenario(rng, TrialKind(3.0, push=3000.0))
    for trials, more in (([lasts], 0.0), ([falls], 6.0), ([lasts, falls], 3.0)):
        free, dear = (
            Stage("a", 1, 0.1, np.ones(1), {"style": 0.3, "fall": fall, "soft": 0.0}) for fall in (0.0, 6.0)
        )
        free, dear = (problem.evaluate(stage, problem.genes, trials)[0] for stage in (free, dear))
        assert dear - free == pytest.approx(more)


def test_whoever_falls_sooner_is_not_better_off_for_what_it_is_spared() -> None:
    figures = dict.fromkeys(FIGURES, 0.0)
    trials = [
        Trial(figures | {"time": t, "speed_error": 0.75 * t}, np.zeros(0)) for t in (0.3, 0.6, 0.9, 1.2)
    ]
    costs = [cost(trial, 4.0, style=0.3) for trial in trials]
    assert all(later < sooner for sooner, later in itertools.pairwise(costs))
    hopeless = Trial(figures | {"time": 4.0, "speed_error": 50.0}, np.zeros(0))
    assert cost(hopeless, 4.0, style=0.3) == 10.0


def test_hard_landings_cost_what_the_stage_says() -> None:
    peaks = [0.0]

    def note(simulator: Simulator) -> None:
        if simulator.state[STEP_TIME] == 0.0:
            peaks.append(0.0)
        peaks[-1] = max(peaks[-1], float(simulator.state[CONTACT].sum()) / (MASS * 9.81))

    scenario = Scenario(3.0, np.array([[0.0, 5.0]]), np.array([[0.0, 0.5]]))
    trial = Simulator().run(load_run_skill(), scenario, note)
    hard = np.maximum(np.array(peaks[:-1]) - 2.8, 0.0)  # the last step is not over
    assert trial.figures["landing"] == pytest.approx(np.sqrt((hard**2).mean())) and hard.max() > 0.3
    softly = Trial(trial.figures | {"landing": 0.0}, np.zeros(0))
    more = cost(trial, 3.0, 0.3, soft=2.0) - cost(softly, 3.0, 0.3, soft=2.0)
    assert more == pytest.approx(2.0 * trial.figures["landing"])
    assert cost(trial, 3.0, 0.3) == cost(softly, 3.0, 0.3)


def test_a_run_that_steps_as_often_as_a_captured_person_costs_least() -> None:
    def costs(speed: float, soft: float = 0.0) -> np.ndarray:
        figures = dict.fromkeys(FIGURES, 0.0) | {"time": 4.0, "speed": speed}
        trials = [Trial(figures | {"step_rate": rate}, np.zeros(0)) for rate in rates]
        return np.array([cost(trial, 4.0, style=0.0, soft=soft) for trial in trials])

    rates = np.arange(2.0, 5.0, 0.01)
    assert rates[np.argmin(costs(5.26))] == pytest.approx(3.69)
    assert rates[np.argmin(costs(3.5))] == pytest.approx(3.44, abs=0.006)  # equation 8
    np.testing.assert_allclose(costs(3.5, soft=2.0), 3.0 * costs(3.5))


def test_same_trial_same_outcome() -> None:
    skill = skill_of(tiny_problem().start(), first_state_reference())
    scenario = draw_scenario(
        np.random.default_rng(1), TrialKind(1.0, noise=0.5, push=50.0, tilt=0.05, lateral=1.0)
    )
    first, second = (Simulator().run(skill, scenario) for _ in range(2))
    assert first.figures == second.figures
    np.testing.assert_array_equal(first.state, second.state)
