"""glTF: everything that moves, repeats or packs geometry gives the right triangles, or is refused by name."""

import math

import numpy as np
import pytest

from navmesh import NavmeshError
from tests.navmesh.meshfiles.gltf_files import SQUARE, TWO, Gltf, load, square
from tests.navmesh.meshfiles.mesh_measures import area, upward_area


def test_is_y_up_in_metres_unless_told_otherwise(tmp_path):
    terrain = load(tmp_path, square())
    np.testing.assert_allclose(terrain.bounds, [[0, 0, 0], [4, 4, 0]])
    assert upward_area(terrain) == pytest.approx(16)
    np.testing.assert_allclose(load(tmp_path, square(), up="z").bounds, [[0, 0, -4], [4, 0, 0]])
    np.testing.assert_allclose(load(tmp_path, square(), scale=0.5).bounds, [[0, 0, 0], [2, 2, 0]])


@pytest.mark.parametrize(
    ("mode", "indices", "square_metres"),
    [
        (4, TWO, 16),
        (5, [0, 1, 3, 2], 16),
        (6, [0, 1, 2, 3], 16),
        (6, [1, 2, 3, 0], 16),
        (5, [0, 1], 0),
        (6, [0], 0),
        (0, [0, 1, 2, 3], 0),
        (1, [0, 1, 2, 3], 0),
        (2, [0, 1, 2, 3], 0),
        (3, [0, 1, 2, 3], 0),
    ],
)
def test_modes(tmp_path, mode, indices, square_metres):
    file = Gltf()
    file.node(mesh=file.mesh(SQUARE, indices, mode=mode))
    if not square_metres:
        with pytest.raises(NavmeshError, match="no triangles"):
            load(tmp_path, file)
        return
    terrain = load(tmp_path, file)
    assert area(terrain) == pytest.approx(square_metres)
    assert upward_area(terrain) == pytest.approx(square_metres)  # none is turned over


@pytest.mark.parametrize(("mode", "order"), [(4, TWO), (5, [0, 1, 3, 2]), (6, [0, 1, 2, 3])])
@pytest.mark.parametrize("kind", [np.uint8, np.uint16, np.uint32, None])
def test_kinds_of_indices(tmp_path, mode, order, kind):
    file = Gltf()
    points = SQUARE if kind else SQUARE[order]
    file.node(mesh=file.mesh(points, file.array(np.array(order, kind)) if kind else None, mode=mode))
    assert upward_area(load(tmp_path, file)) == pytest.approx(16)


@pytest.mark.parametrize("kind", [np.int8, np.uint8, np.int16, np.uint16])
@pytest.mark.parametrize("normalized", [True, False])
def test_quantized_positions(tmp_path, kind, normalized):
    most = np.iinfo(kind).max
    signed = np.iinfo(kind).min < 0
    corners = np.round(SQUARE / 4 * most if signed else (SQUARE + np.array([0, 0, 4])) / 4 * most)
    file = Gltf()
    file.require("KHR_mesh_quantization")
    points = file.array(corners.astype(kind), stride=4 * np.dtype(kind).itemsize, normalized=normalized)
    size = 4.0 if normalized else 4.0 / most
    file.node(mesh=file.mesh(points, TWO), scale=[size] * 3, translation=[0, 0, 0 if signed else -4])
    np.testing.assert_allclose(load(tmp_path, file).bounds, [[0, 0, 0], [4, 4, 0]], atol=1e-6)


def test_interleaved_positions_with_offsets(tmp_path):
    rows = np.zeros((5, 7), np.float32)
    rows[1:, 2:5] = SQUARE
    file = Gltf()
    view = file.view(rows.tobytes(), byteStride=28)
    points = file.accessor("f", 4, 3, bufferView=view, byteOffset=28 + 8)
    file.node(mesh=file.mesh(points, TWO))
    np.testing.assert_allclose(load(tmp_path, file).bounds, [[0, 0, 0], [4, 4, 0]])


@pytest.mark.parametrize("base", [True, False])
def test_sparse_positions(tmp_path, base):
    file = Gltf()
    kept = [0, 1, 2, 3] if not base else [1, 2]
    values = SQUARE.copy()
    values[[1, 2], 0] = 8.0
    sparse = {
        "count": len(kept),
        "indices": {"bufferView": file.view(np.uint16(kept).tobytes()), "componentType": 5123},
        "values": {"bufferView": file.view(values[kept].tobytes())},
    }
    more = {"bufferView": file.view(SQUARE.tobytes())} if base else {}
    file.node(mesh=file.mesh(file.accessor("f", 4, 3, sparse=sparse, **more), TWO))
    assert area(load(tmp_path, file)) == pytest.approx(32)


def test_nodes_in_nodes(tmp_path):
    file = Gltf()
    mesh = file.mesh(SQUARE, TWO)
    half = math.sqrt(0.5)
    file.node(children=[1, 2], translation=[10, 0, 0], scale=[2, 2, 2])
    file.node(mesh=mesh, rotation=[0, half, 0, half])  # a quarter turn about Y: x to -z
    file.node(mesh=mesh, matrix=[1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 5, 0, 1], children=[3])
    file.node(mesh=mesh, translation=[0, 5, 0])
    file.node(mesh=mesh, translation=[1000, 0, 0])  # in no scene
    terrain = load(tmp_path, file)
    assert area(terrain) == pytest.approx(3 * 64)
    np.testing.assert_allclose(terrain.bounds, [[2, 0, 0], [18, 8, 20]], atol=1e-6)


@pytest.mark.parametrize("scale", [[-1, 1, 1], [1, 1, -1], [-1, -1, -1], [-1, 1, -1]])
def test_mirrored_nodes_keep_their_upper_side(tmp_path, scale):
    turned = -1.0 if scale[1] < 0 else 1.0
    assert upward_area(load(tmp_path, square(scale=scale))) == pytest.approx(16 * turned)


@pytest.mark.parametrize("normalized", [True, False])
def test_gpu_instancing(tmp_path, normalized):
    file = Gltf()
    half = math.sqrt(0.5)
    turns = np.array([[0, 0, 0, 1], [0, half, 0, half], [0, 0, 0, 1]])
    rotation = (
        file.array(np.round(turns * 127).astype(np.int8), normalized=True)
        if normalized
        else file.array(turns.astype(np.float32))
    )
    attributes = {
        "TRANSLATION": file.array(np.float32([[0, 0, 0], [10, 0, 0], [20, 0, 0]])),
        "ROTATION": rotation,
        "SCALE": file.array(np.float32([[1, 1, 1], [1, 1, 1], [2, 2, 2]])),
    }
    file.require("EXT_mesh_gpu_instancing")
    extensions = {"EXT_mesh_gpu_instancing": {"attributes": attributes}}
    file.node(mesh=file.mesh(SQUARE, TWO), extensions=extensions, translation=[0, 3, 0])
    terrain = load(tmp_path, file)
    assert area(terrain) == pytest.approx(16 + 16 + 64)
    np.testing.assert_allclose(terrain.bounds, [[0, 0, 3], [28, 8, 3]], atol=1e-5)


def skinned(weights=True):
    """A square bound to two joints; the second one has moved 1 m up since."""
    file = Gltf()
    attributes = {}
    if weights:
        attributes = {
            "JOINTS_0": file.array(np.uint8([[0, 1, 0, 0]] * 4)),
            "WEIGHTS_0": file.array(np.float32([[1, 0, 0, 0], [0.5, 0.5, 0, 0], [0, 1, 0, 0], [0, 2, 0, 0]])),
        }
    bound = np.tile(np.eye(4, dtype=np.float32), (2, 1, 1))
    bound[:, 0, 3] = -7.0  # the joints stood at x = 7
    file.json["scenes"] = [{"nodes": [0, 1]}]
    file.node(mesh=file.mesh(SQUARE, TWO, attributes=attributes), skin=0, translation=[50, 0, 0])
    file.node(translation=[7, 0, 0], children=[2])
    file.node(translation=[0, 1, 0])
    inverse = file.array(bound.transpose(0, 2, 1).reshape(2, 16))
    file.json["skins"] = [{"joints": [1, 2], "inverseBindMatrices": inverse}]
    return file


def test_skins(tmp_path):
    terrain = load(tmp_path, skinned())
    np.testing.assert_allclose(terrain.vertices[:, 2], [0, 0.5, 1, 1], atol=1e-6)
    np.testing.assert_allclose(terrain.bounds[:, :2], [[0, 0], [4, 4]], atol=1e-6)


def test_a_skinned_mesh_without_weights_stays_as_it_is(tmp_path):
    np.testing.assert_allclose(load(tmp_path, skinned(False)).bounds, [[0, 0, 0], [4, 4, 0]])


@pytest.mark.parametrize("of", ["mesh", "node"])
def test_morph_targets(tmp_path, of):
    file = Gltf()
    up = np.zeros((4, 3), np.float32)
    up[:, 1] = 2.0
    number = file.mesh(SQUARE, TWO, targets=[{"POSITION": file.array(up)}, {"NORMAL": file.array(up)}])
    file.json["meshes"][number]["weights"] = [0.5 if of == "mesh" else 0.0, 0.0]
    file.node(mesh=number, **({"weights": [0.5, 0.0]} if of == "node" else {}))
    np.testing.assert_allclose(load(tmp_path, file).bounds, [[0, 0, 1], [4, 4, 1]])


def test_hidden_nodes_are_left_out(tmp_path):
    file = square(children=[1])
    file.node(children=[2], extensions={"KHR_node_visibility": {"visible": False}})
    file.node(mesh=0, translation=[100, 0, 0])
    assert area(load(tmp_path, file)) == pytest.approx(16)
