"""`NodeGraph.update`: after any sequence of changes the graph is the one that a build of the whole gives."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from benchmarks.large_levels import large_level
from benchmarks.shared_data import level_path, shared_folder
from navmesh import NavmeshError, NodeGraph, Terrain, WalkRules, join_chunks, split_terrain
from navmesh.graph import kept_build
from navmesh.obstacles.tagging import TagFile
from navmesh.obstacles.tags import Addition, Tags
from tests.navmesh.pieces import PIECES, SPOTS, assert_same, piece, rebuilt
from tests.navmesh.shapes import quad, terrain


@pytest.fixture(autouse=True, scope="module")
def never_the_whole():
    """Small levels are renewed as large ones are."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(kept_build, "WHOLE", np.inf)
        patch.setattr(kept_build, "MOST", np.inf)
        yield


change = st.dictionaries(
    st.sampled_from(SPOTS), st.sampled_from([None, *PIECES]), min_size=1, max_size=3
)  # fmt: skip


@settings(max_examples=25, deadline=None)
@given(st.lists(change, min_size=1, max_size=5), st.sampled_from([(0.25, 0.2), (0.2, 0.4)]))
def test_any_sequence_of_changes_gives_the_graph_of_a_build(sequence, rules):
    level = {f"{i},{j}": piece("floor", (i, j)) for i, j in SPOTS}
    graph = NodeGraph.build(join_chunks(level), WalkRules(resolution=rules[0], max_step=rules[1]))
    for changes in sequence:
        named = {
            f"{i},{j}": None if kind is None else piece(kind, (i, j)) for (i, j), kind in changes.items()
        }
        named = {name: new for name, new in named.items() if new is not None or name in level}
        level = {name: chunk for name, chunk in {**level, **named}.items() if chunk is not None}
        if not level:
            return
        graph = graph.update(named)
        assert_same(graph, rebuilt(graph))
        assert graph.terrain.digest == join_chunks(level).digest


@pytest.mark.parametrize(
    ("kind", "size", "side"), [("city", 1, 5.0), ("hills", 24, 6.0), ("clutter", 1, 4.0)]
)
def test_random_changes_of_generated_levels(kind, size, side):
    chunks = split_terrain(large_level(kind, size, 3), side)
    graph = NodeGraph.build(join_chunks(chunks))
    rng = np.random.default_rng(1)
    there = dict(chunks)
    for turn in range(10):
        name = sorted(chunks)[rng.integers(len(chunks))]
        moved = Terrain.from_arrays(chunks[name].vertices + rng.uniform(-0.5, 0.5, 3), chunks[name].faces)
        change = (
            None if turn % 3 == 0 and name in there and len(there) > 1 else (moved, chunks[name])[turn % 2]
        )
        there = {**there, name: change}
        if change is None:
            del there[name]
        graph = graph.update({name: change})
        assert_same(graph, rebuilt(graph))
        assert graph.terrain.digest == join_chunks(there).digest


@pytest.mark.parametrize("name", ["dungeon", "nav_test"])
def test_a_real_level_in_chunks(name):
    if shared_folder() is None:
        pytest.skip("needs the shared levels")
    chunks = split_terrain(Terrain.load(level_path(name), up="y"), 10.0)
    graph = NodeGraph.build(join_chunks(chunks))
    rng = np.random.default_rng(0)
    for key in rng.choice(sorted(chunks), 3, replace=False):
        graph = graph.update({str(key): None})
        assert_same(graph, rebuilt(graph))
        graph = graph.update({str(key): chunks[key]})
    assert_same(graph, rebuilt(graph))


def test_the_order_of_changes_does_not_show():
    a, b = {"b": piece("wall", (1, 0))}, {"c": piece("ramp", (2, 0)), "a": piece("platform", (0, 0))}
    level = join_chunks({"a": piece("floor", (0, 0)), "b": piece("floor", (1, 0))})
    extent = [(0, 0, 0), (12, 4, 0)]
    one = NodeGraph.build(level, extent=extent).update(a).update(b)
    other = NodeGraph.build(level, extent=extent).update(b).update(a)
    assert_same(one, other)


def test_a_level_grows_beyond_its_grid():
    graph = NodeGraph.build(join_chunks({"a": piece("floor", (0, 0))}))
    grown = graph.update({"b": piece("storeys", (-2, 3)), "c": piece("floor", (5, 0))})
    assert_same(grown, rebuilt(grown))
    assert grown.surface.shape != graph.surface.shape
    more = grown.update({"d": piece("wall", (0, 1))})
    assert more.surface.shape == grown.surface.shape
    assert_same(more, rebuilt(more))


def test_a_chunk_with_nothing_around_it_is_removed():
    chunks = {"here": piece("platform", (0, 0)), "there": piece("platform", (3, 3))}
    graph = NodeGraph.build(join_chunks(chunks))
    alone = join_chunks({"here": chunks["here"]})
    assert_same(graph.update({"there": None}), NodeGraph.build(alone, extent=graph.extent))


def test_the_graph_before_stays_as_it_is():
    graph = NodeGraph.build(join_chunks({"a": piece("floor", (0, 0)), "b": piece("floor", (1, 0))}))
    before = graph.positions.copy(), graph.surface.nearest.copy(), graph.surface.blocker.copy()
    graph.update({"b": piece("wall", (1, 0))})
    for old, now in zip(before, (graph.positions, graph.surface.nearest, graph.surface.blocker), strict=True):
        np.testing.assert_array_equal(old, now)


def test_saved_and_loaded_graphs_can_be_updated(tmp_path):
    tags = TagFile(
        Tags(
            version=1,
            add=[
                Addition(
                    name="bench", affordance="vault", position=[2.0, 2.0, 0.8], run_towards_deg=0,
                    height=0.8, depth=0.4, width=1.5, run_up=1.5, landing=1.2,
                )
            ],
        )
    )  # fmt: skip
    level = join_chunks({"a": piece("floor", (0, 0)), "b": piece("platform", (1, 0))})
    graph = NodeGraph.build(level, tags=tags)
    graph.save(tmp_path / "level.nav")
    loaded = NodeGraph.load(tmp_path / "level.nav", level)
    assert loaded.terrain.chunks == level.chunks
    changes = {"b": piece("wall", (1, 0)), "c": piece("floor", (0, 1))}
    one, other = graph.update(changes), loaded.update(changes)
    assert_same(one, other)
    assert "bench" in other.obstacles.tag
    assert_same(other.update({"c": None}), rebuilt(one.update({"c": None})))


@pytest.mark.parametrize("most", [0.0, 0.3])
def test_where_a_change_reaches_far_discs_are_chosen_in_the_whole(monkeypatch, most):
    monkeypatch.setattr(kept_build, "MOST", most)
    level = {f"{i},{j}": piece("floor", (i, j)) for i, j in SPOTS}
    graph = NodeGraph.build(join_chunks(level)).update({"1,1": piece("wall", (1, 1)), "2,2": None})
    assert_same(graph, rebuilt(graph))


@pytest.mark.parametrize("most", [0.0, np.inf])
def test_all_floor_goes_in_one_place_and_comes_in_another(monkeypatch, most):
    monkeypatch.setattr(kept_build, "MOST", most)
    extent = [(0, 0, 0), (40, 4, 0)]
    graph = NodeGraph.build(join_chunks({"a": piece("floor", (0, 0))}), extent=extent)
    moved = graph.update({"a": None, "b": piece("floor", (8, 0))})
    assert_same(moved, rebuilt(moved))


def test_most_of_a_level_is_built_anew_as_a_whole(monkeypatch):
    monkeypatch.setattr(kept_build, "WHOLE", 0.5)
    monkeypatch.setattr(kept_build, "renew_surface", None)
    graph = NodeGraph.build(join_chunks({"a": piece("floor", (0, 0)), "b": piece("floor", (1, 0))}))
    changed = graph.update({"b": piece("wall", (1, 0))})
    assert_same(changed, rebuilt(changed))


def test_wrong_changes_are_refused():
    graph = NodeGraph.build(join_chunks({"a": piece("floor", (0, 0))}))
    with pytest.raises(NavmeshError, match="no chunk 'b' to remove; there are a"):
        graph.update({"b": None})
    with pytest.raises(NavmeshError, match="removes all chunks"):
        graph.update({"a": None})
    with pytest.raises(NavmeshError, match="expected a Terrain"):
        graph.update({"a": "floor"})
    with pytest.raises(NavmeshError, match="nothing to walk on"):
        graph.update({"a": terrain(quad((0, 0, 0), (0, 4, 0), (4, 4, 0), (4, 0, 0)))})
    with pytest.raises(NavmeshError, match="extent"):
        NodeGraph.build(piece("floor", (0, 0)), extent=[(1, 1, 1), (0, 0, 0)])
    assert graph.update({"a": piece("floor", (0, 0))}) is graph
