"""Whole worlds in files: a run goes on from one as if it had never stopped."""

import dataclasses
import json
import subprocess
import sys
import textwrap

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

import navmesh
from runtime import RuntimeInputError, World, WorldState
from runtime.bodies.registry import body_names
from runtime.planning.planning import Plan
from runtime.planning.rules import person_walk_rules
from runtime.world.state import STATE_FILE
from runtime.world.state_file import pack, unpack
from surefoot.files.archive import ArchiveError, write_archive

STAIR = [
    ((0.0, 0.0, 0.0), (16.0, 5.0, 0.0)),
    ((16.0, 0.0, 0.4), (30.0, 5.0, 0.4)),
]


@pytest.fixture(scope="module")
def stair(tmp_path_factory):
    """A floor before a platform of 0.4 m, baked to a file."""
    corners, faces = [], []
    for (x0, y0, z), (x1, y1, _) in STAIR:
        faces += [[len(corners) + k for k in triangle] for triangle in ((0, 1, 2), (0, 2, 3))]
        corners += [(x0, y0, z), (x1, y0, z), (x1, y1, z), (x0, y1, z)]
    faces += [[len(corners) + k for k in triangle] for triangle in ((0, 1, 2), (0, 2, 3))]
    corners += [(16.0, 5.0, 0.0), (16.0, 0.0, 0.0), (16.0, 0.0, 0.4), (16.0, 5.0, 0.4)]
    path = tmp_path_factory.mktemp("stair") / "stair.npz"
    terrain = navmesh.Terrain.from_arrays(np.array(corners), np.array(faces), name="stair")
    navmesh.NodeGraph.build(terrain, person_walk_rules()).save(path)
    return path


CONTINUE = textwrap.dedent("""\
    import sys, navmesh
    from runtime import World, WorldState
    world = World(navmesh.NodeGraph.load(sys.argv[1]))
    world.restore(WorldState.read(sys.argv[2]))
    for _ in range(int(sys.argv[3])):
        world.step(1 / 60)
    print(world.state_hash(), [str(event) for event in world.events])
""")


def test_from_a_save_in_mid_air_a_new_process_ends_with_the_same_hash(stair, tmp_path):
    world = World(navmesh.NodeGraph.load(stair), seed=4)
    ada = world.spawn("human", (2.0, 2.5, 0.0), name="ada")
    ada.go_to((27.0, 2.5, 0.4), speed=3.3)
    world.spawn("cat", (3.0, 1.0, 0.0)).go_to((8.0, 4.0, 0.0), speed=1.5)
    world.events  # noqa: B018
    while not (ada.status == "jumping" and _airborne(ada)):
        world.step(1 / 60)
        assert ada.moving
    world.random.random(3)
    world.save().write(tmp_path / "state.npz")
    frames = 150
    for _ in range(frames):
        world.step(1 / 60)
    told = f"{world.state_hash()} {[str(event) for event in world.events]}"
    assert "runs on after the jump" in told and "arrives" in told
    command = [sys.executable, "-c", CONTINUE, str(stair), str(tmp_path / "state.npz"), str(frames)]
    answer = subprocess.run(command, stdout=subprocess.PIPE, text=True, check=True)
    assert answer.stdout.strip() == told


def _airborne(agent):
    """Whether both feet are off the ground."""
    names = list(agent.figure.bodies)
    feet = agent.pose.transforms[[names.index("left_toes"), names.index("right_toes")], :3]
    floor = np.where(feet[:, 0] < 16.0, 0.0, 0.4)
    return bool((feet[:, 2] - floor > 0.06).all())


@pytest.mark.parametrize("body", body_names())
def test_every_body_goes_on_from_a_file(graph, tmp_path, body):
    world = World(graph)
    agent = world.spawn(body, (2.5, 3.0, 0.0), name="it")
    agent.go_to((9.0, 2.0, 0.0), speed=1.2)
    world.step(1.0)
    world.save().write(tmp_path / "state.npz")
    copy = World(graph)
    copy.restore(WorldState.read(tmp_path / "state.npz"))
    assert copy.state_hash() == world.state_hash() and copy.agents["it"].status == agent.status
    for each in (world, copy):
        each.step(1.0)
    assert copy.state_hash() == world.state_hash()
    assert copy.events == world.events and copy.agents["it"].progress == agent.progress
    assert (copy.agents["it"].pose.transforms == agent.pose.transforms).all()


def test_restoring_makes_and_removes_agents_and_keeps_those_that_stay(graph):
    world = World(graph)
    ada = world.spawn("human", (2.0, 3.0, 0.0), name="ada")
    rex = world.spawn("dog", (5.0, 3.0, 0.0), name="rex")
    ada.go_to((9.0, 3.0, 0.0), speed=3.0)
    world.step(0.5)
    saved, digest = world.save(), world.state_hash()
    rex.remove()
    world.spawn("cat", (7.0, 3.0, 0.0), name="tom")
    world.step(0.5)
    world.restore(saved)
    assert list(world.agents) == ["ada", "rex"] and world.agents["ada"] is ada
    assert world.state_hash() == digest
    world.step(0.5)
    other = World(graph)
    other.restore(saved)
    other.step(0.5)
    assert other.state_hash() == world.state_hash()


def test_what_callbacks_have_not_heard_yet_is_saved(graph):
    world, heard = World(graph), []
    world.listen(heard.append)
    world.spawn("dog", (2.0, 3.0, 0.0)).go_to((9.0, 3.0, 0.0), speed=1.0)
    saved = world.save()
    world.step(0.01)
    assert [event.kind for event in heard] == ["Departed"]
    world.restore(saved)
    world.step(0.01)
    assert [event.kind for event in heard] == ["Departed", "Departed"]


def test_refuses_a_state_of_another_level(graph, stair):
    with pytest.raises(RuntimeInputError, match="same mesh and walk rules"):
        World(navmesh.NodeGraph.load(stair)).restore(World(graph).save())


def test_refuses_people_who_have_learned_something_else(graph, tmp_path):
    world = World(graph)
    world.spawn("dog", (3.0, 3.0, 0.0))
    assert world.save().skills == ""
    world.spawn("human", (2.0, 2.0, 0.0))
    world.save().write(tmp_path / "state.npz")
    state = WorldState.read(tmp_path / "state.npz")
    world.restore(state)
    before = world.state_hash()
    package, own, known = state.skills.split()
    for skills, what in (
        (f"{known} {own} {known}", "other skills of the package, who .* with the release that saved it$"),
        (
            f"{package} {own} {package}",
            "other preconditions, who .* the preconditions that it was saved with",
        ),
        (
            f"{package} {known} {package}",
            "other skills of their own and other preconditions, who .*skills=.* and with",
        ),
        ("0123456789abcdef", "other skills of the package and other skills of their own and other preco"),
    ):
        with pytest.raises(RuntimeInputError, match=f"the state is of people with {what}"):
            world.restore(dataclasses.replace(state, skills=skills))
    assert world.state_hash() == before


def test_a_state_that_does_not_fit_leaves_the_world_as_it_was(graph):
    world = World(graph)
    world.spawn("dog", (5.0, 3.0, 0.0))
    agent = world.spawn("human", (2.0, 3.0, 0.0))
    saved = world.save()
    human, *others = saved.agents[agent.name].driver
    broken = dataclasses.replace(
        saved.agents[agent.name], driver=(human._replace(numbers=human.numbers[:-1]), *others)
    )
    world.step(0.1)
    digest = world.state_hash()
    with pytest.raises(RuntimeInputError, match="does not fit this release"):
        world.restore(dataclasses.replace(saved, agents={**saved.agents, agent.name: broken}))
    assert world.state_hash() == digest


def in_the_way(world):
    """How many discs those in the world are made of."""
    return sum(len(population.in_the_way()) for population in world._populations)


def test_after_a_state_that_does_not_fit_all_are_who_they_were(graph):
    world = World(graph)
    human, dog = world.spawn("human", (2.0, 3.0, 0.0)), world.spawn("dog", (5.0, 3.0, 0.0))
    saved, digest, bodies = world.save(), world.state_hash(), in_the_way(world)
    whole = saved.agents[human.name]
    human_state, *others = whole.driver
    short = dataclasses.replace(
        whole, driver=(human_state._replace(numbers=human_state.numbers[:-1]), *others)
    )
    goose = dataclasses.replace(saved.agents[dog.name], body="goose")
    for agents in ({"ada": short}, {human.name: whole, "gus": goose}, {human.name: None}):
        with pytest.raises(RuntimeInputError, match="does not fit this release"):
            world.restore(dataclasses.replace(saved, agents=agents))
        assert world.agents == {human.name: human, dog.name: dog}
        assert world.state_hash() == digest
        assert in_the_way(world) == bodies


def test_a_speed_of_any_kind_of_float_can_be_written(graph, tmp_path):
    world = World(graph)
    world.spawn("dog", (5.0, 3.0, 0.0)).go_to((9.0, 3.0, 0.0), np.float32(1.0), np.float32(0.5))
    world.save().write(tmp_path / "state.npz")
    assert WorldState.read(tmp_path / "state.npz").agents["dog1"].errand.facing == 0.5


def raw(path):
    """Header and arrays of an archive as they are, unchecked."""
    with np.load(path) as file:
        arrays = dict(file)
    return json.loads(arrays.pop("header").tobytes()), arrays


def test_refuses_files_that_are_no_state(graph, tmp_path):
    path = tmp_path / "state.npz"
    with pytest.raises(ArchiveError, match="no such file"):
        WorldState.read(path)
    world = World(graph)
    world.spawn("dog", (5.0, 3.0, 0.0))
    world.save().write(path)
    whole = path.read_bytes()
    for length in (0, 10, len(whole) // 2, len(whole) - 1):
        path.write_bytes(whole[:length])
        with pytest.raises(ArchiveError, match="cut off or damaged"):
            WorldState.read(path)
    path.write_bytes(whole)
    header, arrays = raw(path)
    write_archive(path, STATE_FILE.kind, STATE_FILE.version - 1, header, arrays)
    with pytest.raises(ArchiveError, match=r"written by an older Surefoot.*save the world again"):
        WorldState.read(path)
    for state in (
        None,
        {"class": "subprocess:Popen", "fields": {"args": "true"}},
        {"class": "runtime.world.world:World", "fields": {"terrain": None}},
        {"class": "runtime.world.state:WorldState", "fields": {"level": "x"}},
        {"array": ["float64", 0, [1 << 40]]},
        {"array": "everything"},
    ):
        write_archive(path, STATE_FILE.kind, STATE_FILE.version, {**header, "state": state}, arrays)
        with pytest.raises(RuntimeInputError, match=r"state\.npz"):
            WorldState.read(path)


def test_an_interrupted_write_leaves_the_old_file(graph, tmp_path, monkeypatch):
    path = tmp_path / "state.npz"
    World(graph, seed=1).save().write(path)
    before = path.read_bytes()
    monkeypatch.setattr(np.lib.format, "write_array", _interrupt)
    with pytest.raises(KeyboardInterrupt):
        World(graph, seed=2).save().write(path)
    assert path.read_bytes() == before and list(tmp_path.iterdir()) == [path]


def _interrupt(*_, **__):
    raise KeyboardInterrupt


arrays = st.one_of(
    hnp.arrays(dtype, hnp.array_shapes(min_dims=1, max_dims=3, min_side=0, max_side=4))
    for dtype in (np.float64, np.float32, np.int32, np.bool_)
)
floats = hnp.arrays(np.float64, hnp.array_shapes(min_dims=1, max_dims=3, min_side=0, max_side=4))
plain = st.one_of(st.none(), st.booleans(), st.integers(), st.floats(), st.text())
trees = st.recursive(
    st.one_of(plain, arrays),
    lambda inner: st.one_of(
        st.lists(inner, max_size=4),
        st.lists(inner, max_size=4).map(tuple),
        st.dictionaries(st.text(), inner, max_size=4),
        st.builds(Plan, floats, floats, floats, st.just(()), st.tuples(st.floats(allow_nan=False))),
    ),
    max_leaves=12,
)


@given(trees)
def test_what_is_packed_comes_out_to_the_last_bit(value):
    tree, parts = pack(value)
    assert _same(unpack(json.loads(json.dumps(tree)), parts), value)


def _same(a, b):
    if type(a) is not type(b):
        return False
    if isinstance(b, np.ndarray):
        return a.dtype == b.dtype and a.shape == b.shape and a.tobytes() == b.tobytes()
    if isinstance(b, Plan):
        return all(_same(getattr(a, f.name), getattr(b, f.name)) for f in dataclasses.fields(b))
    if isinstance(b, dict):
        return list(a) == list(b) and all(_same(a[key], b[key]) for key in b)
    if isinstance(b, list | tuple):
        return len(a) == len(b) and all(map(_same, a, b))
    return repr(a) == repr(b)


def test_refuses_to_pack_what_a_file_cannot_hold():
    for value in ({1: 2}, object(), {"x": World}, (lambda: 0,)):
        with pytest.raises(RuntimeInputError, match="cannot hold"):
            pack(value)
