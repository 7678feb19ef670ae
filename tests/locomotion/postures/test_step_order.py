"""Which step follows, by speed and posture."""

import numpy as np
import pytest

from locomotion.postures.posture_file import load_postures
from locomotion.postures.step_order import _choose_all, following, gaits_for, step_name
from surefoot.files.yamlfile import FileError
from tests.locomotion.postures.test_playback import person
from tests.locomotion.postures.test_posture_file import GRAPH, written


def nodes(begin, speeds):
    graph, at, passed = person(), begin, []
    for speed in speeds:
        at = following(graph.postures, graph.gaits, graph.least, at, speed)
        passed.append(at)
    return passed


def test_left_and_right_steps_follow_each_other_while_it_moves():
    assert nodes("stand", [1, 1, 1, 0]) == ["walk left", "walk right", "walk left", "stand"]
    assert nodes("stand", [-0.5, -0.5, 0]) == ["walk backwards left", "walk backwards right", "stand"]


def test_it_runs_from_where_a_walk_is_too_slow_and_back_with_some_play():
    assert nodes("walk left", [2.5, 2.0, 1.8]) == ["run right", "run left", "walk right"]
    assert nodes("walk left", [2.1]) == ["walk right"]
    assert nodes("stand", [9.0]) == ["run left"]  # faster than anything: the fastest


def test_from_a_posture_without_a_gait_it_first_goes_to_the_nearest_with_one():
    assert nodes("kneel", [1, 1]) == ["stand", "walk left"]
    assert nodes("prone", [0.5, 0.5, 0]) == ["crawl", "crawl", "prone"]
    assert nodes("all-fours", [-0.5]) == ["stand"]  # nobody crawls backwards
    assert nodes("dead", [1.0]) == ["dead"]


def test_many_are_chosen_for_as_one_by_one():
    graph, rng = person(), np.random.default_rng(3)
    now = rng.integers(-1, len(graph.gaits), 400).astype(np.int32)
    posture = rng.choice([0, 4, 2], 400).astype(np.int32)
    speed = rng.uniform(-2.0, 7.0, 400)
    chosen = gaits_for(graph.gaits, now, posture, speed)
    for k in range(400):
        able = [g for g, gait in enumerate(graph.gaits) if gait.posture == posture[k]]
        able = [g for g in able if graph.gaits[g].backwards == (speed[k] < 0.0) and abs(speed[k]) > 0.05]
        on = [g for g in able if g == now[k] and graph.gaits[g].slowest <= abs(speed[k])]
        enough = [g for g in on + able if abs(speed[k]) <= graph.gaits[g].fastest]
        best = enough[0] if enough else max(able, key=lambda g: graph.gaits[g].fastest, default=-1)
        assert chosen[k] == best


def test_a_gait_of_one_step_is_called_as_it_is():
    gaits = {gait.name: gait for gait in person().gaits}
    assert step_name(gaits["crawl"], 0) == "crawl" and step_name(gaits["run"], 1) == "run right"


@pytest.mark.parametrize(
    ("gaits", "problem"),
    [
        ("gaits: {walk: {posture: lie, fastest: 2}}", "no posture is called 'lie'"),
        ("gaits: {walk: {posture: stand, slowest: 3, fastest: 2}}", "slowest must be below fastest"),
        ("gaits: {walk: {posture: stand}}", "fastest"),
    ],
)
def test_mistakes_are_told(tmp_path, gaits, problem):
    with pytest.raises(FileError, match=problem):
        load_postures(written(tmp_path, GRAPH + gaits))


def test_a_speed_of_another_type_compiles_nothing_anew():
    graph = person()
    here = np.array([graph.postures.index("stand")])
    for speed in (np.array([1.0]), np.array([1], np.int64), np.array([1.0], np.float32)):
        chosen = gaits_for(graph.gaits, np.array([-1]), here, speed)
        assert graph.gaits[chosen[0]].name == "walk"
    assert len(_choose_all.signatures) == 1
