"""What missions can say: each action, each trigger, each expectation; and their schema."""

import numpy as np
import pytest

from benchmarks.mission_fuzz import MISSION as EVERYTHING
from benchmarks.mission_fuzz import Fuzz, mutated
from locomotion.body.traits import TRAITS
from runtime.events import Arrived, Departed, PostureReached
from runtime.missions.check import prepare_mission
from runtime.missions.model import Style
from surefoot.files.yamlfile import FileError
from surefoot.progress import Progress
from tests.runtime.missions.scripts import REX, load, path_of, refused, run, verdicts


def test_waits_then_goes_through_waypoints(graph, tmp_path):
    steps = "script: [{wait: 1.5}, {goto: [north, east]}], expect: {arrives_within: 15}}\n"
    result = run(graph, tmp_path, REX + steps)
    times, places = path_of(result, "rex")
    assert result.held
    assert np.ptp(places[times < 1.4], axis=0).max() < 0.02
    assert np.linalg.norm(places - (6, 5), axis=1).min() < 1.0  # the dog's rear, cutting the corner
    departures = [event for event in result.events if isinstance(event, Departed)]
    assert [round(event.time, 1) for event in departures] == [1.5]


@pytest.mark.parametrize("apart", [0.0, 1e-13, 1e-6, 1e-3])
def test_places_may_all_but_coincide(graph, tmp_path, apart):
    east = [9 + apart, 3, 0]
    loaded = load(tmp_path, REX + f"goto: [[9, 3, 0], {east}, [9, 3, 0], north]}}\n")
    prepare_mission(loaded, Progress(shown=False), graph)


def test_patrols_as_often_as_it_is_told(graph, tmp_path):
    result = run(graph, tmp_path, REX + "script: [{patrol: {points: [north, west], rounds: 2}}]}\n")
    assert [event.goal[0] for event in result.events if isinstance(event, Arrived)] == pytest.approx(
        [2, 2], abs=0.3
    )
    assert verdicts(result) == {("rex", "arrives"): True}
    timed = run(graph, tmp_path, REX + "script: [{patrol: {points: [north, west], seconds: 4}}]}\n")
    assert 4.0 <= timed.simulated < 7.0 and timed.held


def test_patrols_to_the_end_of_the_mission(graph, tmp_path):
    agents = REX + "script: [{patrol: {points: [north, west]}}]}\n"
    result = run(graph, tmp_path, agents)
    assert result.simulated == pytest.approx(30.0, abs=0.05) and result.checks == ()
    # somebody who has an end ends the mission
    tom = "  - {name: tom, body: cat, start: [9, 1, 0], goto: [[9, 2.5, 0]]}\n"
    assert run(graph, tmp_path, agents + tom).simulated < 10.0


def test_follows_at_a_distance(graph, tmp_path):
    tom = "  - {name: tom, body: cat, start: [4, 3, 0], speed: 1, goto: [east]}\n"
    watched = "expect: {keeps_distance: [{to: tom, at_least: 0.8, at_most: 4}]}}\n"
    result = run(graph, tmp_path, tom + REX + "script: [{follow: {agent: tom, distance: 1.5}}], " + watched)
    assert verdicts(result) == {
        ("tom", "arrives"): True,
        ("rex", "keeps at least 0.8 m and at most 4 m to tom"): True,
    }
    _, rex = path_of(result, "rex")
    assert rex[-1, 0] > 5.5
    stays = run(graph, tmp_path, tom + REX + "script: [{wait: 19}], " + watched)
    assert not verdicts(stays)["rex", "keeps at least 0.8 m and at most 4 m to tom"]


def test_the_same_mission_is_the_same_run(graph, tmp_path):
    agents = "  - {name: tom, body: cat, start: [4, 3, 0], speed: 1, goto: [east]}\n"
    agents += REX + "script: [{follow: {agent: tom, seconds: 3}}, {goto: north}]}\n"
    first, second = (run(graph, tmp_path, agents).trace.state_hash for _ in range(2))
    assert first == second


@pytest.mark.parametrize(
    ("agent", "at", "says"),
    [
        ("script: [{wait: 1}, {goto: [18, 3, 0]}]}", "[18", "[18.0, 3.0, 0.0] cannot be reached"),
        ("script: [{patrol: {points: [east, [18, 3, 0]]}}]}", "[18", "cannot be reached"),
        ("script: [{patrol: {points: [east, west]}}, {wait: 1}]}", "{patrol", "never ends, and more comes"),
        (
            "script: [{patrol: {points: [east, west]}}], expect: {arrives_within: 3}}",
            "3}}",
            "'rex' never ends",
        ),
    ],
)
def test_what_cannot_be_done_is_named(graph, tmp_path, agent, at, says):
    loaded = load(tmp_path, REX + agent + "\n")
    refused(lambda: prepare_mission(loaded, Progress(shown=False), graph), REX + agent, at, says)


def test_hundreds_of_mutated_files_run_or_are_refused_with_a_place(tmp_path):
    fuzz = Fuzz(tmp_path, seconds=0.05)
    assert fuzz.attempt(EVERYTHING.encode())[0] == "ran"
    random = np.random.default_rng(7)
    outcomes = [fuzz.attempt(mutated(random)) for _ in range(200)]
    assert [said for outcome, said in outcomes if outcome == "wrong"] == []
    assert {"ran", "refused on reading", "refused on the level"} <= {outcome for outcome, _ in outcomes}


BOB = "  - {name: bob, start: west, detail: low, "


def test_takes_postures_and_holds_things(graph, tmp_path):
    steps = "script: [{hold: {object: rifle}}, {posture: kneel}, {goto: [[4, 3, 0]], speed: 1.5}]}\n"
    result = run(graph, tmp_path, BOB + steps)
    assert result.held
    told = [(e.posture, e.holds) for e in result.events if isinstance(e, PostureReached)]
    assert told[:2] == [("stand", "rifle deployed"), ("kneel", "rifle deployed")]


@pytest.mark.parametrize(
    ("agent", "at", "says"),
    [
        (BOB + "script: [{posture: fly}]}", "posture", "'stand', 'crouch'"),
        (BOB + "script: [{hold: {object: spear}}]}", "hold", "'rifle'"),
        (BOB.replace("low", "high") + "goto: east}", "detail", "'auto', 'physics'"),
        (REX + "script: [{posture: sit}]}", "posture", "a dog has no postures"),
        (REX + "detail: low, goto: east}", "detail", "valid: physics"),
        (REX + "style: {arms: 1.4}, goto: east}", "style", "only people have"),
        (BOB + "style: {arm: 1.4}, goto: east}", "style", "unknown key 'arm'|arm"),
        (BOB + "style: {lean: 1.4}, goto: east}", "style", "0.3"),
    ],
)
def test_postures_that_there_are_not_are_refused(graph, tmp_path, agent, at, says):
    with pytest.raises(FileError, match=says):
        run(graph, tmp_path, agent + "\n")


def test_a_mission_says_how_people_differ(graph, tmp_path):
    loaded = load(tmp_path, BOB + "style: {arms: 1.7, size: 0.9}, goto: east}\n")
    bob = prepare_mission(loaded, Progress(shown=False), graph).world.agents["bob"]
    assert (bob.driver.traits["arms"], bob.driver.traits["size"]) == (1.7, 0.9)


def test_the_style_of_missions_has_the_traits_that_there_are():
    """Names and ranges are those of `locomotion.body.traits.TRAITS`."""
    fields = Style.model_json_schema()["properties"]
    ranges = {
        name: [field["anyOf"][0][end] for end in ("minimum", "maximum")] for name, field in fields.items()
    }
    assert ranges == {name: list(ends) for name, (_, *ends) in TRAITS.items()}


def test_a_mission_says_who_looks_on(graph, tmp_path):
    loaded = load(
        tmp_path, BOB.replace("low", "auto") + "goto: east}\n", "viewers: [{position: [0, 3, 1.7]}]\n"
    )
    world = prepare_mission(loaded, Progress(shown=False), graph).world
    assert world.viewers[0].position == (0.0, 3.0, 1.7) and world.agents["bob"].detail == "auto"
