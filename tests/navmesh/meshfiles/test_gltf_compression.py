"""Compressed glTF: Draco and meshopt; without their packages the error says what helps."""

import sys

import numpy as np
import pytest

from navmesh import NavmeshError
from tests.navmesh.meshfiles.gltf_files import SQUARE, TWO, Gltf, load, square
from tests.navmesh.meshfiles.mesh_measures import area, upward_area


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
