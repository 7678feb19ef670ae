"""What missions can say: each action, each trigger, each expectation; and their schema."""

import json
import re
from pathlib import Path

import numpy as np
import pytest

from benchmarks.mission_fuzz import MISSION as EVERYTHING
from benchmarks.mission_fuzz import Fuzz, mutated, write_level
from runtime.events import Arrived, Departed, Told
from runtime.missions.check import prepare_mission
from runtime.missions.mission import load_mission, mission_schema
from runtime.missions.run import run_mission
from surefoot.files.yamlfile import FileError
from surefoot.progress import Progress
from tests.small_level import obj_text

EXAMPLES = Path(__file__).parents[3] / "examples" / "missions"
HEAD = """\
level: {file: level.obj}
time_limit: 30
waypoints: {west: [2, 3, 0], east: [9, 3, 0], north: [6, 5, 0]}
regions:
  east side: {min: [5, 0, -1], max: [12, 6, 1]}
  north side: {center: [6, 6, 0], radius: 2}
agents:
"""
HEAD = HEAD.replace(" side:", "_side:")


def load(tmp_path, agents, triggers=""):
    """The mission of ``agents`` on the small level."""
    (tmp_path / "level.obj").write_text(obj_text())
    (tmp_path / "mission.yaml").write_text(HEAD + agents + triggers)
    return load_mission(tmp_path / "mission.yaml")


def run(graph, *parts):
    loaded = load(*parts)
    return run_mission(loaded, prepared=prepare_mission(loaded, Progress(shown=False), graph))


def verdicts(result):
    return {(check.agent, check.expected): check.held for check in result.checks}


def path_of(result, name):
    agent = next(each for each in result.trace.agents if each.name == name)
    return result.trace.times, agent.poses[:, 0, :2].astype(float)


REX = "  - {name: rex, body: dog, start: west, speed: 2, "


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


def test_a_person_uses_a_skill_by_name(tmp_path):
    write_level(tmp_path)
    text = (
        "level: {file: level.obj}\nagents:\n  - {name: ada, start: [1, 3, 0], speed: 3, script: [{use: %s}], "
    )
    text += "expect: {uses_skills: [jump]}}\n"
    (tmp_path / "mission.yaml").write_text(text % "{skill: jump, obstacle: ledge}")
    result = run_mission(load_mission(tmp_path / "mission.yaml"))
    assert verdicts(result)["ada", "uses skill jump"]
    for use, says in (
        ("{skill: vault, obstacle: ledge}", "obstacle to vault"),
        ("{skill: jump, obstacle: leedge}", "did you mean 'ledge'? valid: ledge"),
        ("{skill: jump, near: [3, 3, 0]}", "no obstacle to jump lies within 3 m"),
    ):
        (tmp_path / "mission.yaml").write_text(text % use)
        with pytest.raises(FileError, match=re.escape(says)):
            prepare_mission(load_mission(tmp_path / "mission.yaml"), Progress(shown=False))


@pytest.mark.parametrize(
    ("when", "why"),
    [
        ("{after: 2}", "2 s are over"),
        ("{arrives: tom}", "tom arrives"),
        ("{enters: {agent: tom, region: north_side}}", "tom enters north_side"),
    ],
)
def test_triggers_give_new_scripts(graph, tmp_path, when, why):
    agents = (
        "  - {name: tom, body: cat, start: [6, 2, 0], speed: 1, goto: [north]}\n" + REX + "goto: [east]}\n"
    )
    triggers = f"triggers:\n  - {{when: {when}, then: [{{agent: rex, do: [{{goto: west, speed: 1.5}}]}}]}}\n"
    result = run(graph, tmp_path, agents, triggers)
    (told,) = [event for event in result.events if isinstance(event, Told)]
    assert (told.agent, told.why) == ("rex", why)
    assert result.held
    _, rex = path_of(result, "rex")
    assert rex[-1, 0] < 3.0 and rex[:, 0].max() > 3.0


def test_a_fall_is_noticed_and_the_fallen_fail(graph, tmp_path, monkeypatch):
    agents = "  - {name: ada, start: west, goto: [east]}\n" + REX + "}\n"
    agents = agents.replace("speed: 2, }", "speed: 2}")
    triggers = "triggers:\n  - {when: {falls: ada}, then: [{agent: rex, do: [{goto: north}]}]}\n"
    loaded = load(tmp_path, agents, triggers)
    prepared = prepare_mission(loaded, Progress(shown=False), graph)
    human, step = prepared.world.agents["ada"].human, prepared.world.step

    def pushed(dt):
        human.data.qvel[3:5] = 9.0
        return step(dt)

    monkeypatch.setattr(prepared.world, "step", pushed)
    result = run_mission(loaded, prepared=prepared)
    assert [event.why for event in result.events if isinstance(event, Told)] == ["ada falls"]
    assert verdicts(result) == {("ada", "arrives"): False, ("rex", "arrives"): True}


def test_stays_out_of_a_region(graph, tmp_path):
    out = "goto: [[3, 1, 0]], expect: {stays_out_of: [east_side, north_side]}}\n"
    assert run(graph, tmp_path, REX + out).held
    through = run(graph, tmp_path, REX + out.replace("[3, 1, 0]", "[8, 1, 0]"))
    held = {expected: held for (_, expected), held in verdicts(through).items()}
    assert held == {"arrives": True, "stays out of east_side": False, "stays out of north_side": True}


def test_the_same_mission_is_the_same_run(graph, tmp_path):
    agents = "  - {name: tom, body: cat, start: [4, 3, 0], speed: 1, goto: [east]}\n"
    agents += REX + "script: [{follow: {agent: tom, seconds: 3}}, {goto: north}]}\n"
    first, second = (run(graph, tmp_path, agents).trace.state_hash for _ in range(2))
    assert first == second


def refused(call, text, at, says):
    """``call`` is refused with a message about the place of ``at`` in the eighth line, ``text``."""
    with pytest.raises(FileError) as caught:
        call()
    assert f"mission.yaml:8:{text.index(at) + 1}: " in str(caught.value) and says in str(caught.value)


@pytest.mark.parametrize(
    ("agent", "at", "says"),
    [
        ("goto: [noth]}", "noth", "agents[0].goto[0]: no waypoint is called 'noth'; did you mean 'north'?"),
        (
            "goto: noth}",
            "noth",
            "no waypoint is called 'noth'; did you mean 'north'? valid: west, east, north",
        ),
        ("goto: [9, x, 0]}", "x, 0", "agents[0].goto[1]: Input should be a valid number, not 'x'"),
        ("script: [{follow: {agent: tom}}]}", "tom", "no agent is called 'tom'; valid: rex"),
        ("script: [{follow: {agent: rex}}]}", "rex}}]", "'rex' is this agent itself"),
        (
            "script: [{wait: 1, goto: east}]}",
            "{wait",
            "one action is needed: goto, wait, follow, patrol or use",
        ),
        (
            "script: [{wate: 1}]}",
            "wate",
            "did you mean 'wait'? valid: goto, wait, follow, patrol, use, speed",
        ),
        ("script: [{wait: 1, speed: 2}]}", "{wait", "waiting has no speed"),
        ("script: [{patrol: {points: [west]}}]}", "[west", "at least 2 items"),
        (
            "script: [{use: {skill: fly, near: west}}]}",
            "fly",
            "'jump', 'vault', 'drop-roll' or 'leap', not 'fly'",
        ),
        ("script: [{goto: east}], goto: west}", "{name", "either goto or script, not both"),
        ("expect: {stays_out_of: [moon]}}", "moon", "no region is called 'moon'; valid: east_side"),
        ("expect: {keeps_distance: [{to: rex}]}}", "{to", "at_least, at_most or both are needed"),
        ("goto: [a b]}", "a b", "a name is a letter and up to 39 letters, digits, - and _, not 'a b'"),
    ],
)
def test_mistakes_are_named(tmp_path, agent, at, says):
    refused(lambda: load(tmp_path, REX + agent + "\n"), REX + agent, at, says)


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


def test_the_schema_beside_the_examples_is_current():
    written = json.loads((EXAMPLES / "mission.schema.json").read_text(encoding="utf-8"))
    assert written == mission_schema(), "surefoot schema -o examples/missions/mission.schema.json"


@pytest.mark.parametrize("path", sorted(EXAMPLES.glob("*.yaml")), ids=lambda path: path.stem)
def test_examples_point_editors_to_the_schema(path):
    first = path.read_text(encoding="utf-8").splitlines()[0]
    named = re.fullmatch(r"# yaml-language-server: \$schema=(\S+)", first)
    assert named is not None and (path.parent / named[1]).is_file()
    load_mission(path)


def test_hundreds_of_mutated_files_run_or_are_refused_with_a_place(tmp_path):
    fuzz = Fuzz(tmp_path, seconds=0.05)
    assert fuzz.attempt(EVERYTHING.encode())[0] == "ran"
    random = np.random.default_rng(7)
    outcomes = [fuzz.attempt(mutated(random)) for _ in range(200)]
    assert [said for outcome, said in outcomes if outcome == "wrong"] == []
    assert {"ran", "refused on reading", "refused on the level"} <= {outcome for outcome, _ in outcomes}
