"""Animated glTF: valid by the Khronos Group's own validator, and where it moves the bodies to."""

import json
import os
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

from runtime.bodies.figure import rotate, turn
from runtime.views.gltf import write_gltf

pygltflib = pytest.importorskip("pygltflib", reason="not there: pip install -e '.[gltf]'")
ROOT = Path(__file__).parents[3]
VALIDATE = """
const validator = require('gltf-validator');
const bytes = new Uint8Array(require('fs').readFileSync(process.argv[1]));
validator.validateBytes(bytes).then(report => console.log(JSON.stringify(report)));
"""


def validator_is_there():
    if shutil.which("node") is None:
        return False
    found = subprocess.run(["node", "-e", "require('gltf-validator')"], cwd=ROOT, capture_output=True)
    return found.returncode == 0


@pytest.fixture(scope="module")
def file(trace, tmp_path_factory):
    path = tmp_path_factory.mktemp("gltf") / "run.glb"
    write_gltf(trace, path)
    assert [each.name for each in path.parent.iterdir()] == ["run.glb"]
    return path


@pytest.mark.skipif(
    not validator_is_there(), reason="gltf-validator is not there: npm install gltf-validator"
)
def test_the_khronos_validator_finds_nothing(file):
    command = ["node", "-e", VALIDATE, str(file)]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, env=dict(os.environ), check=True)
    report = json.loads(done.stdout)
    issues = report["issues"]
    assert (issues["numErrors"], issues["numWarnings"]) == (0, 0), issues["messages"]
    assert report["info"]["animationCount"] == 1 and report["info"]["totalTriangleCount"] > 1000


def values_of(gltf, index):
    accessor = gltf.accessors[index]
    view = gltf.bufferViews[accessor.bufferView]
    size = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}[accessor.type]
    data = gltf.binary_blob()[view.byteOffset : view.byteOffset + view.byteLength]
    return np.frombuffer(data, np.float32).reshape(-1, size).astype(float)


def test_the_nodes_go_where_the_bodies_went(trace, file):
    gltf = pygltflib.GLTF2().load(str(file))
    moves = {}
    for channel in gltf.animations[0].channels:
        sampler = gltf.animations[0].samplers[channel.sampler]
        np.testing.assert_allclose(
            values_of(gltf, sampler.input)[:, 0], trace.times - trace.times[0], atol=1e-6
        )
        moves[channel.target.node, channel.target.path] = values_of(gltf, sampler.output)
    parents = {child: k for k, node in enumerate(gltf.nodes) for child in node.children or ()}

    def world(index, k):
        """Position and quaternion (w first) of a node at pose k, along its parents."""
        node = gltf.nodes[index]
        place = moves.get((index, "translation"))
        turned = moves.get((index, "rotation"))
        place = np.array(node.translation or (0, 0, 0)) if place is None else place[k]
        turned = np.array(node.rotation or (0, 0, 0, 1)) if turned is None else turned[k]
        turned = turned[[3, 0, 1, 2]]
        if index not in parents:
            return place, turned
        above, above_turned = world(parents[index], k)
        return above + rotate(above_turned, place), turn(above_turned, turned)

    agent = trace.agents[0]
    for b, name in enumerate(agent.figure.bodies):
        (index,) = [k for k, node in enumerate(gltf.nodes) if node.name == f"ada/{name}"]
        for k in range(len(trace.times)):
            x, y, z = agent.poses[k, b, :3]
            place, _ = world(index, k)
            np.testing.assert_allclose(place, (x, z, -y), atol=1e-4)  # Y up


def test_the_level_stands_upright_in_other_programs(trace, file):
    import trimesh

    scene = trimesh.load(file)
    low, high = scene.bounds
    level = trace.level.vertices
    assert high[0] == pytest.approx(level[:, 0].max(), abs=1e-4)
    assert low[2] == pytest.approx(-level[:, 1].max(), abs=1e-4)
    assert 1.4 < high[1] - low[1] < 2.0  # the person on the floor is the highest thing
