"""glTF: everything that moves, repeats or packs geometry gives the right triangles, or is refused by name."""

import base64
import json
import math
import re
import sys

import numpy as np
import pytest

from navmesh import NavmeshError, Terrain
from tests.navmesh.meshfiles.gltf_files import Gltf
from tests.navmesh.meshfiles.mesh_measures import area, upward_area

SQUARE = np.array([[0, 0, 0], [4, 0, 0], [4, 0, -4], [0, 0, -4]], np.float32)  # a floor, Y up
TWO = [0, 1, 2, 0, 2, 3]


def load(tmp_path, file, name="level.glb", **options):
    path = tmp_path / name
    path.write_bytes(file.glb() if isinstance(file, Gltf) else file)
    return Terrain.load(path, **options)


def square(**node):
    file = Gltf()
    file.node(mesh=file.mesh(SQUARE, TWO), **node)
    return file


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


def test_draco(tmp_path):
    DracoPy = pytest.importorskip("DracoPy")
    packed = DracoPy.encode(SQUARE, np.uint32(TWO).reshape(-1, 3), quantization_bits=16)
    file = Gltf()
    file.require("KHR_draco_mesh_compression")
    extension = {"bufferView": file.view(packed), "attributes": {"POSITION": 0}}
    points, indices = file.accessor("f", 4, 3), file.accessor("H", 6, 1)
    file.node(
        mesh=file.mesh(points, indices, extensions={"KHR_draco_mesh_compression": extension}),
        translation=[1, 0, 0],
    )
    terrain = load(tmp_path, file)
    assert upward_area(terrain) == pytest.approx(16, rel=1e-4)
    np.testing.assert_allclose(terrain.bounds, [[1, 0, 0], [5, 4, 0]], atol=1e-3)
    file.data = file.data[: len(file.data) // 2] + b"\xff" * (len(file.data) - len(file.data) // 2)
    with pytest.raises(NavmeshError, match="damaged"):
        load(tmp_path, file)


def meshopt_view(file, packed, count, stride, mode, **more):
    """A bufferView as a compressor writes it: the plain buffer is a fallback without data."""
    extension = {
        "buffer": 0,
        "byteOffset": 0,
        "byteLength": len(packed),
        "byteStride": stride,
        "count": count,
    }
    name = more.pop("name", "EXT_meshopt_compression")
    number = file.view(packed)
    extension["byteOffset"] = file.json["bufferViews"][number]["byteOffset"]
    file.json["bufferViews"][number] = {
        "buffer": 1, "byteLength": count * stride, "extensions": {name: extension | {"mode": mode} | more},
    }  # fmt: skip
    return number


@pytest.mark.parametrize("name", ["EXT_meshopt_compression", "KHR_meshopt_compression"])
@pytest.mark.parametrize("mode", ["TRIANGLES", "INDICES"])
def test_meshopt(tmp_path, name, mode):
    meshopt = pytest.importorskip("meshopt")
    rng = np.random.default_rng(1)
    grid = np.stack(np.meshgrid(np.arange(30.0), [0.0], -np.arange(30.0), indexing="ij"), axis=-1).reshape(
        -1, 3
    )
    grid[:, 1] = rng.random(900)
    first = np.arange(900).reshape(30, 30)[:-1, :-1].ravel()
    faces = np.c_[first, first + 30, first + 31, first, first + 31, first + 1].reshape(-1, 3)
    file, plain = Gltf(), Gltf()
    file.require(name)
    points = meshopt.encode_gltf_buffer(grid.astype(np.float32), "ATTRIBUTES")
    indices = meshopt.encode_gltf_buffer(faces.astype(np.uint32), mode)
    at = meshopt_view(file, points, 900, 12, "ATTRIBUTES", name=name)
    named = meshopt_view(file, indices, faces.size, 4, mode, name=name)
    number = file.mesh(
        file.accessor("f", 900, 3, bufferView=at), file.accessor("I", faces.size, 1, bufferView=named)
    )
    file.node(mesh=number)
    file.json["buffers"] = [
        {"byteLength": len(file.data)},
        {"byteLength": 10**6, "extensions": {name: {"fallback": True}}},
    ]
    plain.node(mesh=plain.mesh(grid, plain.array(faces.ravel().astype(np.uint32))))
    found, expected = load(tmp_path, file), load(tmp_path, plain)
    assert area(found) == pytest.approx(area(expected), rel=1e-12)
    assert upward_area(found) == pytest.approx(29 * 29)
    file.json["bufferViews"][at]["extensions"][name]["count"] = 10**9
    with pytest.raises(NavmeshError, match="cannot hold"):
        load(tmp_path, file)


def test_meshopt_exponential_filter(tmp_path):
    meshopt = pytest.importorskip("meshopt")
    rows = meshopt.encode_filter_exp(SQUARE, 20)
    file = Gltf()
    packed = meshopt.encode_gltf_buffer(rows, "ATTRIBUTES")
    at = meshopt_view(file, packed, 4, 12, "ATTRIBUTES", filter="EXPONENTIAL")
    file.node(mesh=file.mesh(file.accessor("f", 4, 3, bufferView=at), TWO))
    file.json["buffers"] = [{"byteLength": len(file.data)}, {"byteLength": 48}]
    np.testing.assert_allclose(load(tmp_path, file).bounds, [[0, 0, 0], [4, 4, 0]], atol=1e-4)


def test_compression_that_is_not_required_is_passed_over(tmp_path, monkeypatch):
    for package in ("DracoPy", "meshopt"):
        monkeypatch.setitem(sys.modules, package, None)
    file = square()
    compressed = {"buffer": 0, "byteLength": 8, "byteStride": 12, "count": 4, "mode": "ATTRIBUTES"}
    file.json["bufferViews"][0]["extensions"] = {"EXT_meshopt_compression": compressed}
    extension = {"bufferView": 0, "attributes": {"POSITION": 0}}
    file.json["meshes"][0]["primitives"][0]["extensions"] = {"KHR_draco_mesh_compression": extension}
    assert area(load(tmp_path, file)) == pytest.approx(16)


@pytest.mark.parametrize(("package", "what"), [("DracoPy", "Draco"), ("meshopt", "meshopt")])
def test_compression_without_its_package_says_what_helps(tmp_path, monkeypatch, package, what):
    monkeypatch.setitem(sys.modules, package, None)
    file = Gltf()
    if package == "DracoPy":
        extension = {"bufferView": file.view(b"DRACO"), "attributes": {"POSITION": 0}}
        mesh = file.mesh(file.accessor("f", 4, 3), extensions={"KHR_draco_mesh_compression": extension})
    else:
        view = meshopt_view(file, b"x" * 9, 4, 12, "ATTRIBUTES")
        mesh = file.mesh(file.accessor("f", 4, 3, bufferView=view))
        file.json["buffers"] = [{"byteLength": len(file.data)}, {"byteLength": 48}]
    file.node(mesh=mesh)
    with pytest.raises(NavmeshError, match=rf"compressed with {what}.*\[meshes\].*export without"):
        load(tmp_path, file)


def test_buffers_beside_the_file_and_within_it(tmp_path):
    file = square()
    (tmp_path / "the level.bin").write_bytes(file.data)
    for uri in (
        "the%20level.bin",
        "data:application/octet-stream;base64," + base64.b64encode(file.data).decode(),
    ):
        file.json["buffers"] = [{"byteLength": len(file.data), "uri": uri}]
        assert area(load(tmp_path, json.dumps(file.json).encode(), "level.gltf")) == pytest.approx(16)
    for uri, says in [("no.bin", "missing"), ("https://example.org/a.bin", "not beside"), (7, "file's name")]:
        file.json["buffers"] = [{"byteLength": len(file.data), "uri": uri}]
        with pytest.raises(NavmeshError, match=f"{says}"):
            load(tmp_path, json.dumps(file.json).encode(), "level.gltf")


def edited(change):
    file = square()
    change(file.json)
    return file


@pytest.mark.parametrize(
    ("change", "says"),
    [
        (lambda j: j.update(extensionsRequired=["VENDOR_unknown"]), "requires the extension VENDOR_unknown"),
        (lambda j: j.update(asset={"version": "1.0"}), "version 1.0"),
        (lambda j: j.update(asset=None), "expected a glTF file"),
        (lambda j: j["nodes"][0].update(mesh=3), "nodes[0]: refers to meshes[3]"),
        (lambda j: j["nodes"][0].update(mesh=-1), "refers to meshes[-1]"),
        (lambda j: j["nodes"][0].update(scale=[1, "a", 1]), "scale"),
        (lambda j: j["nodes"][0].update(rotation=[0, 0, 0, 0]), "rotation of length 0"),
        (lambda j: j["nodes"][0].update(children=[0]), "own ancestor"),
        (lambda j: j["nodes"][0].update(skin=0), "skins[0]; there are 0"),
        (lambda j: j["scenes"][0].update(nodes=[5]), "refers to nodes[5]"),
        (lambda j: j.update(scene=2), "scenes[2]"),
        (lambda j: j.update(meshes={}), "expected a list"),
        (lambda j: j["meshes"][0]["primitives"][0].update(mode=9), "mode = 9"),
        (lambda j: j["meshes"][0]["primitives"][0].update(attributes={}), "no triangles"),
        (lambda j: j["meshes"][0]["primitives"][0].update(attributes=None), "no attributes"),
        (lambda j: j["meshes"][0]["primitives"][0].update(indices=0), "needs 'SCALAR'"),
        (lambda j: j["accessors"][0].update(count=5), "reach beyond"),
        (lambda j: j["accessors"][0].update(count=-1), "count = -1"),
        (lambda j: j["accessors"][0].update(count=10**12), "reach beyond"),
        (lambda j: j["accessors"][0].pop("bufferView") or j["accessors"][0].update(count=10**12), "no data"),
        (lambda j: j["accessors"][0].update(componentType=5130), "componentType"),
        (lambda j: j["accessors"][0].update(byteOffset=40), "reach beyond"),
        (lambda j: j["accessors"][1].update(count=5), "5 indices"),
        (lambda j: j["accessors"][0].update(count=2), "indices reach to 3"),
        (lambda j: j["bufferViews"][0].update(byteLength=10**9), "reach beyond"),
        (lambda j: j["bufferViews"][0].update(byteStride=4), "byteStride = 4"),
        (lambda j: j["bufferViews"][0].update(buffer=1), "buffers[1]"),
        (lambda j: j.update(buffers=[{"byteLength": 10**9}]), "cut off"),
        (lambda j: j["accessors"][0].update(sparse={"count": 1}), "sparse"),
    ],
)
def test_what_is_wrong_is_named(tmp_path, change, says):
    with pytest.raises(NavmeshError, match=rf"level\.glb: .*{re.escape(says)}"):
        load(tmp_path, edited(change))


@pytest.mark.parametrize("length", [0, 3, 11, 19, 40, 400, -1])
def test_files_that_are_cut_off(tmp_path, length):
    with pytest.raises(NavmeshError, match=r"level\.glb: "):
        load(tmp_path, square().glb()[:length])
