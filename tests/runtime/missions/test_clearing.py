"""Which obstacle `use` means, and where the run-up to it begins."""

import re

import numpy as np
import pytest

from benchmarks.mission_fuzz import write_level
from runtime.missions.check import prepare_mission
from runtime.missions.clearing import find_clearing
from runtime.missions.mission import load_mission
from runtime.missions.model import Use
from runtime.missions.run import run_mission
from surefoot.files.yamlfile import FileError
from surefoot.progress import Progress
from tests.runtime.missions.scripts import verdicts


@pytest.fixture(scope="module")
def prepared(tmp_path_factory):
    folder = tmp_path_factory.mktemp("clearing")
    write_level(folder)
    (folder / "mission.yaml").write_text(
        "level: {file: level.obj}\n"
        "agents:\n"
        "  - {name: ada, start: [1, 3, 0], speed: 3, script: [{use: {skill: jump, obstacle: ledge}}],\n"
        "     expect: {uses_skills: [jump]}}\n"
        "  - {name: rex, body: dog, start: [1, 1, 0]}\n"
    )
    loaded = load_mission(folder / "mission.yaml")
    return loaded, prepare_mission(loaded, Progress(shown=False)).world


ADDRESS = ("agents", 0, "script", 0, "use")


def test_a_person_uses_a_skill_by_name(prepared):
    loaded, world = prepared
    result = run_mission(loaded, prepared=prepare_mission(loaded, Progress(shown=False), world.graph))
    assert verdicts(result)["ada", "uses skill jump"]


@pytest.mark.parametrize(
    ("use", "says"),
    [
        (Use(skill="vault", obstacle="ledge"), "obstacle to vault"),
        (Use(skill="jump", obstacle="leedge"), "did you mean 'ledge'? valid: ledge"),
        (Use(skill="jump", near=[3.0, 3.0, 0.0]), "no obstacle to jump lies within 3 m"),
    ],
)
def test_an_obstacle_that_is_not_there_is_named(prepared, use, says):
    loaded, world = prepared
    with pytest.raises(FileError, match=re.escape(says)):
        find_clearing(loaded, world, world.agents["ada"], ADDRESS, use)


def test_the_run_up_is_straight_and_ends_beyond_the_edge(prepared):
    loaded, world = prepared
    obstacles = world.graph.obstacles
    index = int(np.flatnonzero((obstacles.tag == "ledge") & (obstacles.affordance == "jump"))[0])
    use = Use(skill="jump", obstacle="ledge")
    before, beyond = find_clearing(loaded, world, world.agents["ada"], ADDRESS, use)
    edge, outward = obstacles.position[index], obstacles.normal[index]
    assert before[2] == pytest.approx(edge[2] - obstacles.height[index])
    assert beyond[2] == pytest.approx(before[2] + obstacles.rise[index])
    far = (before - edge)[:2] @ outward[:2]
    assert 0.5 <= far <= min(8.0, obstacles.run_up[index])
    assert (beyond - edge)[:2] @ outward[:2] < 0.0
    across = np.array([-outward[1], outward[0]])
    assert [(place - edge)[:2] @ across for place in (before, beyond)] == pytest.approx([0.0, 0.0])
    near = Use(skill="jump", near=edge.tolist())
    found = find_clearing(loaded, world, world.agents["ada"], ADDRESS, near)
    assert np.array_equal(found, [before, beyond])


def test_a_body_without_the_skill_is_named(prepared):
    loaded, world = prepared
    with pytest.raises(FileError, match=r"skill: a dog has no skill 'jump'; valid: none"):
        find_clearing(loaded, world, world.agents["rex"], ADDRESS, Use(skill="jump", obstacle="ledge"))


def test_an_obstacle_beyond_the_skill_is_told_with_both_sizes(prepared, monkeypatch):
    loaded, world = prepared
    monkeypatch.setattr("runtime.world.agent.Agent.skills", {"jump": (0.01, 0.02)})
    with pytest.raises(FileError, match=r"ledge is 0\.[0-9]{2} m high; ada can jump 0\.01 to 0\.02 m"):
        find_clearing(loaded, world, world.agents["ada"], ADDRESS, Use(skill="jump", obstacle="ledge"))
