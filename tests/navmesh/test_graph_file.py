"""Saving and loading the graph: the same back, and a clear error for every file that does not fit."""

import numpy as np
import pytest
from shapes import box, plane, terrain

from navmesh import NavmeshError, NodeGraph, Terrain, WalkRules
from navmesh.files import archive

LEVEL = (plane(0, 6, 0, 6), box(2, 3, 2, 3, 0, 2))


@pytest.fixture(scope="module")
def level() -> Terrain:
    return terrain(*LEVEL)


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
    for name in ("column_start", "height", "link", "clearance", "nearest"):
        np.testing.assert_array_equal(getattr(back.surface, name), getattr(graph.surface, name))
    assert back.clearance_at((1, 1, 0)) == graph.clearance_at((1, 1, 0))


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
