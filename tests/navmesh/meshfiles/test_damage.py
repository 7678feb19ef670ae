"""Mesh files with bytes changed, left out or put in are read, or refused by `NavmeshError`."""

import json
import re
import tracemalloc

import numpy as np
import pytest

from navmesh import NavmeshError, Terrain
from tests.navmesh.meshfiles.gltf_files import SQUARE, TWO, Gltf
from tests.navmesh.meshfiles.small_files import binary_stl, off, ply, stl
from tests.navmesh.meshfiles.test_gltf import skinned
from tests.navmesh.meshfiles.test_obj import prisms, spelled

MUTATIONS = 60


def rich_gltf():
    """A file with skin, instances, sparse points and morph targets."""
    file = skinned()
    up = np.float32([[0, 1, 0]] * 4)
    number = file.mesh(SQUARE, TWO, targets=[{"POSITION": file.array(up)}])
    file.json["meshes"][number]["weights"] = [0.5]
    sparse = {
        "count": 2,
        "indices": {"bufferView": file.view(np.uint16([1, 2]).tobytes()), "componentType": 5123},
        "values": {"bufferView": file.view(SQUARE[:2].tobytes())},
    }
    file.json["accessors"][file.json["meshes"][number]["primitives"][0]["attributes"]["POSITION"]][
        "sparse"
    ] = sparse
    many = {"attributes": {"TRANSLATION": file.array(np.float32([[0, 0, 0], [9, 0, 0]]))}}
    file.json["scenes"][0]["nodes"].append(
        file.node(mesh=number, extensions={"EXT_mesh_gpu_instancing": many}, rotation=[0, 0, 0, 1])
    )
    return file


def compressed_gltf():
    DracoPy = pytest.importorskip("DracoPy", reason="needs the extra meshes")
    meshopt = pytest.importorskip("meshopt", reason="needs the extra meshes")
    file = Gltf()
    file.require("KHR_draco_mesh_compression")
    file.require("EXT_meshopt_compression")
    packed = {
        "bufferView": file.view(DracoPy.encode(SQUARE, np.uint32(TWO).reshape(-1, 3))),
        "attributes": {"POSITION": 0},
    }
    extensions = {"KHR_draco_mesh_compression": packed}
    points, indices = file.accessor("f", 4, 3), file.accessor("H", 6, 1)
    one = file.mesh(points, indices, extensions=extensions)
    rows = meshopt.encode_gltf_buffer(SQUARE, "ATTRIBUTES")
    view = file.view(rows)
    plain = file.json["bufferViews"][view]
    plain["extensions"] = {
        "EXT_meshopt_compression": {**plain, "byteStride": 12, "count": 4, "mode": "ATTRIBUTES"}
    }
    two = file.mesh(file.accessor("f", 4, 3, bufferView=view), TWO)
    file.json["scenes"] = [{"nodes": [file.node(mesh=one), file.node(mesh=two)]}]
    return file


def good_files(kind):
    rng = np.random.default_rng(5)
    points, outlines, *_ = prisms(rng)
    return {
        "obj": lambda: spelled(rng, points, outlines).encode(),
        "ply": lambda: ply("ascii", points.tolist(), outlines),
        "binary.ply": lambda: ply("binary_big_endian", points.tolist(), outlines),
        "stl": lambda: stl(*(points[each].tolist() for each in outlines)).encode(),
        "binary.stl": lambda: binary_stl(),
        "off": lambda: off().encode(),
        "glb": lambda: rich_gltf().glb(),
        "compressed.glb": lambda: compressed_gltf().glb(),
        "gltf": lambda: json.dumps(rich_gltf().json).encode(),
    }[kind]()


def damaged(rng, content):
    """The content with one or a few changes."""
    data = bytearray(content)
    for _ in range(int(rng.integers(1, 4))):
        at = int(rng.integers(len(data)))
        match int(rng.integers(5)):
            case 0:
                data[at] ^= 1 << int(rng.integers(8))
            case 1:
                data[at : at + int(rng.integers(1, 9))] = b""
            case 2:
                data[at:at] = rng.bytes(int(rng.integers(1, 9)))
            case 3:
                data[at : at + 4] = b"\xff\xff\xff\x7f"
            case 4:
                numbers = list(re.finditer(rb"\d+", data))
                if numbers:
                    found = numbers[int(rng.integers(len(numbers)))]
                    data[found.start() : found.end()] = rng.choice(
                        [b"-1", b"99999999", b"0", b"nan", b"1e400"]
                    )
        if not data:
            break
    return bytes(data)


@pytest.mark.parametrize(
    "kind", ["obj", "ply", "binary.ply", "stl", "binary.stl", "off", "glb", "compressed.glb", "gltf"]
)
def test_damaged_files_are_read_or_refused(tmp_path, kind):
    rng = np.random.default_rng(11)
    good = good_files(kind)
    file = tmp_path / f"level.{kind}"
    refused = 0
    tracemalloc.start(1)
    try:
        for _ in range(MUTATIONS):
            file.write_bytes(damaged(rng, good))
            try:
                Terrain.load(file)
            except NavmeshError as error:
                assert str(file) in str(error) and "\n" not in str(error)
                refused += 1
        assert tracemalloc.get_traced_memory()[1] < 100e6
    finally:
        tracemalloc.stop()
    assert refused > MUTATIONS // 10
