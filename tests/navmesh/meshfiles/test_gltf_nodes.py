"""The nodes of a glTF file: order, places, what is shown."""

import numpy as np
import pytest

from navmesh import NavmeshError
from navmesh.meshfiles.gltf_document import Document
from navmesh.meshfiles.gltf_nodes import node_order, node_places, numbers_of, shown_nodes, transforms
from tests.navmesh.meshfiles.gltf_files import Gltf


def document_of(tmp_path, *nodes, **top):
    file = Gltf(**top)
    for node in nodes:
        file.node(**node)
    (tmp_path / "nodes.glb").write_bytes(file.glb())
    return Document(tmp_path / "nodes.glb")


def test_parents_come_first_and_places_add_up(tmp_path):
    document = document_of(
        tmp_path, {"translation": [0, 1, 0]}, {"children": [0], "scale": [2, 2, 2], "translation": [3, 0, 0]},
        scenes=[{"nodes": [1]}],
    )  # fmt: skip
    nodes = document.items("nodes")
    order = node_order(document, nodes)
    assert order == [(1, -1), (0, 1)]
    np.testing.assert_allclose(node_places(document, nodes, order)[0, :3, 3], [3, 2, 0])
    assert shown_nodes(document, nodes, order) == {0, 1}


def test_hidden_nodes_and_what_hangs_on_them(tmp_path):
    hidden = {"extensions": {"KHR_node_visibility": {"visible": False}}, "children": [1]}
    document = document_of(tmp_path, hidden, {}, {}, scenes=[{"nodes": [0, 2]}])
    nodes = document.items("nodes")
    assert shown_nodes(document, nodes, node_order(document, nodes)) == {2}


def test_what_is_no_tree_or_no_number(tmp_path):
    document = document_of(tmp_path, {"children": [1]}, {"children": [0]})
    with pytest.raises(NavmeshError, match="its own ancestor"):
        node_order(document, document.items("nodes"))
    with pytest.raises(NavmeshError, match="expected 3 numbers"):
        numbers_of(document, {"scale": [1, "a", 2]}, "scale", 3, None, "nodes[0]")
    with pytest.raises(NavmeshError, match="rotation of length 0"):
        transforms(document, np.zeros((1, 3)), np.zeros((1, 4)), np.ones((1, 3)), "nodes[0]")
