"""The surfaces of meshes, and how skins share them among bones."""

import numpy as np

from navmesh.meshfiles.gltf_document import Document
from navmesh.meshfiles.gltf_surfaces import bone_places, skin_shares, skinned, surfaces
from tests.navmesh.meshfiles.gltf_files import SQUARE, TWO, Gltf


def test_shares_add_up_and_move_points(tmp_path):
    file = Gltf()
    joints = np.array([[0, 1, 0, 0]] * 4, np.uint8)
    weights = np.array([[1, 3, 0, 0], [2, 0, 0, 0], [0, 0, 0, 0], [0, 5, 0, 0]], np.float32)
    attributes = {"JOINTS_0": file.array(joints), "WEIGHTS_0": file.array(weights)}
    file.node(mesh=file.mesh(SQUARE, TWO, attributes=attributes), skin=0)
    file.node()
    file.node(translation=[0, 2, 0])
    file.json["skins"] = [{"joints": [1, 2]}]
    (tmp_path / "skin.glb").write_bytes(file.glb())
    document = Document(tmp_path / "skin.glb")
    (part,) = surfaces(document, document.json["meshes"][0], "meshes[0]")
    assert part.number == 0 and part.faces.shape == (2, 3)
    bones, shares = skin_shares(document, part, 2, "nodes[0]")
    np.testing.assert_allclose(shares.sum(axis=1), 1.0)
    np.testing.assert_allclose(shares[0], [0.25, 0.75, 0, 0])
    assert bones.max() == 1
    placed = np.tile(np.eye(4), (3, 1, 1))
    placed[2, 1, 3] = 2.0
    moved = skinned(document, part, part.points, bone_places(document, 0, placed, "nodes[0]"), "nodes[0]")
    np.testing.assert_allclose(moved[:, 1] - SQUARE[:, 1], [1.5, 0.0, 0.0, 2.0])
