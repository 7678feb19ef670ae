"""Whatever is wrong with a caller's input is refused before anything has changed."""

import pytest

from runtime import World
from runtime.errors import RuntimeInputError
from runtime.missions.mission import load_mission
from surefoot import SurefootError


def test_a_refused_call_leaves_its_world_as_it_was(graph):
    world = World(graph)
    agent = world.spawn("human", (2.0, 3.0, 0.0), name="ada")
    before, events = world.state_hash(), len(world.events)
    for wrong in (
        lambda: world.step(-1.0),
        lambda: world.spawn("goose", (4.0, 3.0, 0.0)),
        lambda: world.spawn("human", (4.0, 3.0, 0.0), name="ada"),
        lambda: agent.go_to((4.0, 3.0, 0.0), speed=0.0),
        lambda: agent.go_to("there"),
        lambda: world.listen(5),
        lambda: world.restore(None),
    ):
        with pytest.raises(RuntimeInputError) as refused:
            wrong()
        assert "\n" not in str(refused.value) and len(str(refused.value)) > 10
    assert (world.state_hash(), len(world.events), list(world.agents)) == (before, events, ["ada"])


def test_one_except_clause_catches_errors_of_calls_and_of_files(graph, tmp_path):
    for wrong in (lambda: World(graph, seed=-1), lambda: load_mission(tmp_path / "none.yaml")):
        with pytest.raises(SurefootError):
            wrong()
