"""A glTF file as a document: where its bytes are, and what is wrong with them."""

import base64
import json
import re

import pytest

from navmesh import NavmeshError
from tests.navmesh.meshfiles.gltf_files import load, square
from tests.navmesh.meshfiles.mesh_measures import area


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
