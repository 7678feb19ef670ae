"""What a mission file may say: mistakes are named, and editors are given the same rules as a schema."""

import json
import re
from pathlib import Path

import pytest
from pydantic import ValidationError

from runtime.missions.mission import load_mission, mission_schema
from runtime.missions.model import AgentSpec, Mission, Region, Step, Use
from tests.runtime.missions.scripts import REX, load, refused

EXAMPLES = Path(__file__).parents[3] / "examples" / "missions"


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
            "one action is needed: goto, wait, follow, patrol, use, posture or hold",
        ),
        (
            "script: [{wate: 1}]}",
            "wate",
            "did you mean 'wait'? valid: goto, wait, follow, patrol, use, posture, hold, speed",
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


def test_the_schema_beside_the_examples_is_current():
    written = json.loads((EXAMPLES / "mission.schema.json").read_text(encoding="utf-8"))
    assert written == mission_schema(), "surefoot schema -o examples/missions/mission.schema.json"


@pytest.mark.parametrize("path", sorted(EXAMPLES.glob("*.yaml")), ids=lambda path: path.stem)
def test_examples_point_editors_to_the_schema(path):
    first = path.read_text(encoding="utf-8").splitlines()[0]
    named = re.fullmatch(r"# yaml-language-server: \$schema=(\S+)", first)
    assert named is not None and (path.parent / named[1]).is_file()
    load_mission(path)


def test_a_goto_is_short_for_a_script():
    spec = {"name": "ada", "start": [0.0, 0.0, 0.0]}
    assert AgentSpec.model_validate({**spec, "goto": "gate"}).steps == (Step(goto="gate"),)
    assert AgentSpec.model_validate({**spec, "script": [{"wait": 1.0}]}).steps == (Step(wait=1.0),)
    assert AgentSpec.model_validate(spec).steps == ()


def test_a_skill_may_be_called_as_its_obstacle():
    """As in files of earlier versions."""
    assert Use(skill="drop", obstacle="x").skill == "drop-roll"


@pytest.mark.parametrize(
    ("region", "says"),
    [
        ({"min": [0.0, 0, 0]}, "either min and max or center and radius"),
        ({"min": [0.0, 0, 0], "max": [1.0, 1, 1], "radius": 1.0}, "either min and max or center and radius"),
        ({"min": [0.0, 0, 0], "max": [1.0, 0, 1]}, "min must be below max"),
        ({"center": [0.0, 0, 2e6], "radius": 1.0}, r"within ±1e\+06 m"),
        ({"center": [0.0, 0, 0], "radius": 0.0}, "greater than 0"),
    ],
)
def test_a_region_is_a_box_or_a_ball(region, says):
    with pytest.raises(ValidationError, match=says):
        Region.model_validate(region)


def test_unknown_bodies_are_refused_and_files_are_not_looked_at_here():
    agent = {"name": "ada", "start": [0.0, 0.0, 0.0]}
    mission = {"level": {"file": "a.obj"}, "agents": [{**agent, "body": "beasts/mutt.yaml"}]}
    assert Mission.model_validate(mission).agents[0].body == "beasts/mutt.yaml"
    with pytest.raises(ValidationError, match=r"'human', .* or '"):
        AgentSpec.model_validate({**agent, "body": "goose"})
