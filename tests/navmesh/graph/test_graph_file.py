"""Saving and loading the graph: the same back, and a clear error for every file that does not fit."""

import json

import numpy as np
import pytest

from navmesh import NavmeshError, NodeGraph, Terrain, WalkRules
from navmesh.graph.graph_file import GRAPH_FILE
from surefoot.files import archive
from tests.navmesh.shapes import box, join, plane, terrain
from tests.navmesh.surface.levels import arrays_of

LEVEL = (plane(0, 6, 0, 6), box(2, 3, 2, 3, 0, 2))


@pytest.fixture(scope="module")
def level() -> Terrain:
    return Terrain.from_arrays(*join(*LEVEL), materials=["floor"] * 2 + ["wall"] * 12)


@pytest.fixture(scope="module")
def graph(level) -> NodeGraph:
    return NodeGraph.build(level, obstacle_rules=None)


def test_loaded_graph_is_the_saved_one(graph, level, tmp_path):
    graph.save(tmp_path / "level.nav")
    back = NodeGraph.load(tmp_path / "level.nav", level, WalkRules())
    assert back.rules == graph.rules
    assert back.surface.shape == graph.surface.shape
    for name in ("positions", "radii", "label", "edge_start", "edge_target", "edge_width", "edge_cells"):
        np.testing.assert_array_equal(getattr(back, name), getattr(graph, name))
    found = arrays_of(back.surface)
    for name, expected in arrays_of(graph.surface).items():
        np.testing.assert_array_equal(found[name], expected, err_msg=name)
    assert back.clearance_at((1, 1, 0)) == graph.clearance_at((1, 1, 0))


def test_a_graph_of_rough_ground_is_read_back(tmp_path):
    """Nodes of narrow places lie between cells: the file was refused as damaged."""
    x, y = np.meshgrid(np.arange(9.0), np.arange(9.0), indexing="ij")
    z = np.random.default_rng(3).uniform(0.0, 2.5, x.shape)
    k = np.arange(8 * 9).reshape(8, 9)[:, :-1].ravel()
    faces = np.concatenate([np.stack([k, k + 9, k + 10], 1), np.stack([k, k + 10, k + 1], 1)])
    rough = Terrain.from_arrays(np.stack([x, y, z], axis=-1).reshape(-1, 3), faces)
    graph = NodeGraph.build(rough, WalkRules(max_step=0.9, headroom=2.0), obstacle_rules=None)
    graph.save(tmp_path / "rough.nav")
    back = NodeGraph.load(tmp_path / "rough.nav")
    np.testing.assert_array_equal(back.positions, graph.positions)


def test_truncated_file_is_refused(graph, tmp_path):
    whole = tmp_path / "level.nav"
    graph.save(whole)
    data = whole.read_bytes()
    for part in (0, 10, len(data) // 2, len(data) - 30):
        cut = tmp_path / "cut.nav"
        cut.write_bytes(data[:part])
        with pytest.raises(archive.ArchiveError, match=r"cut\.nav"):
            NodeGraph.load(cut)


def test_missing_file_is_refused(tmp_path):
    with pytest.raises(archive.ArchiveError, match="no such file"):
        NodeGraph.load(tmp_path / "nowhere.nav")


def test_other_version_is_refused(graph, tmp_path):
    file = tmp_path / "level.nav"
    archive.write_archive(file, "surefoot navigation graph", 999, {}, {"radii": graph.radii})
    with pytest.raises(archive.ArchiveError, match="version 999"):
        NodeGraph.load(file)


def test_other_terrain_or_rules_are_refused(graph, tmp_path):
    file = tmp_path / "level.nav"
    graph.save(file)
    with pytest.raises(NavmeshError, match="another terrain"):
        NodeGraph.load(file, terrain(plane(0, 6, 0, 6)))
    with pytest.raises(NavmeshError, match="baked with"):
        NodeGraph.load(file, rules=WalkRules(max_step=0.1))


def raw(path):
    """Header and arrays of a graph as they are, unchecked."""
    with np.load(path) as file:
        arrays = dict(file)
    return json.loads(arrays.pop("header").tobytes()), arrays


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    """Header and arrays of a graph with obstacles and links."""
    path = tmp_path_factory.mktemp("graph") / "level.nav"
    mesh = join(plane(0, 6, 0, 6), box(2, 4, 2, 4, 0, 0.4))
    level = Terrain.from_arrays(*mesh, materials=["floor"] * 2 + ["wall"] * 12)
    NodeGraph.build(level).save(path)
    return raw(path)


def loaded(tmp_path, header, arrays):
    path = tmp_path / "odd.nav"
    archive.write_archive(path, GRAPH_FILE.kind, GRAPH_FILE.version, header, arrays)
    return NodeGraph.load(path)


def test_the_written_graph_is_read(written, tmp_path):
    assert len(loaded(tmp_path, *written).links) > 0


@pytest.mark.parametrize("name", sorted(set(GRAPH_FILE.arrays_of(None)) - {"terrain_vertices"}))
@pytest.mark.parametrize("value", [2**30, -2])
def test_numbers_out_of_range_are_refused(written, tmp_path, name, value):
    header, arrays = written
    if arrays[name].dtype.kind not in "if":
        pytest.skip("holds no numbers")
    if arrays[name].dtype.kind == "f":
        value = 1e10 if value > 0 else np.nan
    for place in (0, -1):
        odd = arrays[name].copy()
        odd.reshape(-1)[place] = value
        with pytest.raises(archive.ArchiveError, match=r"odd\.nav: .*bake it again$"):
            loaded(tmp_path, header, {**arrays, name: odd})


@pytest.mark.parametrize("name", sorted(GRAPH_FILE.arrays_of(None)))
def test_other_shapes_and_types_are_refused(written, tmp_path, name):
    header, arrays = written
    array = arrays[name]
    for odd in (array[:-1], array[None], np.concatenate([array, array]), array.astype("S8"), array[:0]):
        with pytest.raises(archive.ArchiveError, match=r"odd\.nav"):
            loaded(tmp_path, header, {**arrays, name: odd})


@pytest.mark.parametrize(
    "change",
    [
        {"shape": None}, {"shape": [1, 1]}, {"shape": [-1, -1]}, {"resolution": "x"}, {"resolution": 0.0},
        {"resolution": 0.5}, {"rules": []}, {"rules": {}}, {"rules": {"max_slope": 9.0}}, {"chunks": [[1]]},
        {"chunks": []}, {"chunks": [["level", 1, 1]]}, {"tags": {"x": 1}}, {"tags": 7}, {"terrain": "ab"},
        {"obstacle_rules": {"jump_rise": "x"}}, {"level": None}, {"more": 1},
    ],
)  # fmt: skip
def test_other_headers_are_refused(written, tmp_path, change):
    header, arrays = written
    with pytest.raises(archive.ArchiveError, match=r"odd\.nav"):
        loaded(tmp_path, {**header, **change}, arrays)
    for key in change:
        if key in header:
            with pytest.raises(archive.ArchiveError, match=r"odd\.nav"):
                loaded(tmp_path, {k: v for k, v in header.items() if k != key}, arrays)


def test_what_kernels_rely_on_is_checked_between_arrays(written, tmp_path):
    """In range, but not what it must be: links that lead elsewhere, discs beyond the grid."""
    header, arrays = written
    storey, radii = (arrays[name].copy() for name in ("surface_storey", "radii"))
    storey[-1] = 1  # the last cell is in the corner of the floor: nothing is beyond
    radii[-1] = 7.0
    moved, started = arrays["positions"].copy(), arrays["links_start"].copy()
    moved[0] += [0.3, 0.0, 0.0]
    started[0] += [0.0, 0.3, 0.0]
    for name, odd, said in (
        ("surface_storey", storey, "leads to no cell beside it"),
        ("surface_blocker", arrays["surface_blocker"] + 100.0, "beyond the grid"),
        ("surface_count", np.roll(arrays["surface_count"], 7), "is not in its cell|no cell beside it"),
        ("surface_blocker_count", arrays["surface_blocker_count"] + np.int32(1), "blockers"),
        ("radii", radii, "beyond the grid"),
        ("positions", moved, "not in its cell"),
        ("links_start", started, "not in its cell"),
        ("edge_target", np.zeros_like(arrays["edge_target"]), "its own node"),
        ("obstacles_normal", np.zeros_like(arrays["obstacles_normal"]), "no horizontal direction"),
    ):
        with pytest.raises(archive.ArchiveError, match=said):
            loaded(tmp_path, header, {**arrays, name: odd})
