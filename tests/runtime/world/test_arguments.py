"""What a host passes is checked once, and refused in a sentence that says what would be right."""

from pathlib import Path

import numpy as np
import pytest

from runtime import Event, RuntimeInputError, World
from runtime.world.arguments import checked_files, checked_number, checked_points, checked_whole


def test_refuses_what_is_no_seed_listener_or_state(graph):
    for seed in (-1, 1.5, "one", None, True):
        with pytest.raises(RuntimeInputError, match="seed must be a whole number"):
            World(graph, seed=seed)
    world = World(graph)
    for callback, kind in ((5, Event), (print, int), (print, "Arrived")):
        with pytest.raises(RuntimeInputError, match="listen takes a function and a class"):
            world.listen(callback, kind)
    for state in (None, {}, world):
        with pytest.raises(RuntimeInputError, match="from what save gave"):
            world.restore(state)
    for agent in (None, "human1"):
        with pytest.raises(RuntimeInputError, match="an Agent is removed"):
            world.remove(agent)
    with pytest.raises(RuntimeInputError, match="expected an Event, got 'Arrived'"):
        world.report("Arrived")
    assert world.events == []
    for skills in (None, 5, "hop.yaml", [5]):
        with pytest.raises(RuntimeInputError, match="skills must be a list of files"):
            World(graph, skills=skills)


@pytest.mark.parametrize("dt", [-0.01, np.nan, np.inf, "1", None])
def test_refuses_a_bad_step(graph, dt):
    with pytest.raises(RuntimeInputError, match="dt must be"):
        World(graph).step(dt)


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({"body": "goose"}, "valid: 'human'"),
        ({"at": (50.0, 3.0, 0.0)}, "not near a place"),
        ({"at": (2.0, 3.0)}, "finite"),
        ({"facing": np.nan}, "finite"),
        ({"facing": "north"}, "facing must be a finite number"),
        ({"at": "here"}, "finite"),
        ({"at": [(4.0, 3.0, 0.0)]}, "one point"),
        ({"body": None}, "must be text"),
        ({"name": 5}, "must be text"),
        ({"name": ""}, "must be text"),
        ({"body": "walker", "radius": "wide"}, "radius must be a finite number"),
        ({"name": "ada"}, "taken"),
    ],
)
def test_refuses_a_bad_spawn(graph, change, says):
    world = World(graph)
    world.spawn("human", (2.0, 3.0, 0.0), name="ada")
    with pytest.raises(RuntimeInputError, match=says):
        world.spawn(**{"body": "human", "at": (4.0, 3.0, 0.0), **change})


def test_refuses_a_bad_goal_and_a_bad_level(graph):
    agent = World(graph).spawn("human", (2.0, 3.0, 0.0))
    for point in ((1.0, 2.0), (1.0, np.nan, 0.0), (), None, "there", ("1", "2", "0"), [[[1.0, 2.0, 3.0]]]):
        with pytest.raises(RuntimeInputError, match="finite"):
            agent.go_to(point)
    for speed in (None, "fast", np.nan, 0.0, -1.0, True):
        with pytest.raises(RuntimeInputError, match="speed must be"):
            agent.go_to((4.0, 3.0, 0.0), speed=speed)
    with pytest.raises(RuntimeInputError, match="facing must be"):
        agent.go_to((4.0, 3.0, 0.0), facing="north")
    with pytest.raises(RuntimeInputError, match="a Terrain, a NodeGraph or an OpenWorld"):
        World("level.obj")  # type: ignore[arg-type]


def test_numbers_of_any_library_are_floats():
    for value in (2, 2.0, np.float32(2), np.int64(2)):
        number = checked_number(value, "speed", "m/s")
        assert number == 2.0 and type(number) is float
    assert checked_number(0.5, "speed", "m/s", least=0.5) == 0.5
    with pytest.raises(RuntimeInputError, match=r"^speed .* finite number of at least 0.5 \[m/s\], not 0.4$"):
        checked_number(0.4, "speed", "m/s", least=0.5)
    with pytest.raises(RuntimeInputError, match=r"^facing must be a finite number \[rad\], not '1'$"):
        checked_number("1", "facing", "rad")


def test_one_point_is_a_list_of_one():
    assert checked_points((1, 2, 3), "goal").tolist() == [[1.0, 2.0, 3.0]]
    assert checked_points([(1, 2, 3)] * 2, "goal").shape == (2, 3)


def test_whole_numbers_of_any_library_are_ints():
    assert type(checked_whole(np.uint8(3), "seed")) is int
    with pytest.raises(RuntimeInputError, match=r"^seed must be a whole number of at least 0, not 1.0$"):
        checked_whole(1.0, "seed")


def test_files_are_absolute_paths(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert checked_files(["a.yaml", Path("b") / ".." / "c.yaml"], "skills") == (
        tmp_path.resolve() / "a.yaml", tmp_path.resolve() / "c.yaml",
    )  # fmt: skip
    assert checked_files([], "skills") == ()
    with pytest.raises(RuntimeInputError, match="skills must be a list of files; 5 is none"):
        checked_files(["a.yaml", 5], "skills")
