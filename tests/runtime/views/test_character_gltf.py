"""A run in which people wear a character: valid, where the rig says, and played by three.js."""

import dataclasses
import json
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

from examples.make_characters import CHARACTERS, write_character
from locomotion import Ground, Rig
from locomotion.characters.bone_names import bones_of_parts
from locomotion.characters.character_file import UPRIGHT
from navmesh.meshfiles.gltf_document import Document
from navmesh.meshfiles.gltf_nodes import node_order, node_places
from runtime import RuntimeInputError
from runtime.views.character_gltf import continuous, glb
from runtime.views.gltf import write_gltf
from runtime.views.worn import wears
from tests.runtime.views.test_gltf import ROOT, VALIDATE, validator_is_there

pytest.importorskip("pygltflib", reason="not there: pip install -e '.[gltf]'")
PLAY = """
global.self = global;
const fs = require('fs');
const modules = ['three', 'three/examples/jsm/loaders/GLTFLoader.js'];
Promise.all(modules.map(name => import(name))).then(([THREE, loading]) => {
  const bytes = fs.readFileSync(process.argv[1]);
  const buffer = bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length);
  new loading.GLTFLoader().parse(buffer, '', gltf => {
    const mixer = new THREE.AnimationMixer(gltf.scene);
    mixer.clipAction(gltf.animations[0]).play();
    mixer.setTime(Number(process.argv[2]));
    gltf.scene.updateMatrixWorld(true);
    const found = {};
    gltf.scene.traverse(node => {
      const name = node.userData.name || node.name;
      if (node.isBone) found[name] = node.getWorldPosition(new THREE.Vector3()).toArray();
      if (node.isSkinnedMesh) {
        node.skeleton.update();
        const at = new THREE.Vector3();
        found['mesh'] = node.getVertexPosition(100, at).toArray();
      }
    });
    console.log(JSON.stringify(found));
  }, error => { throw error; });
});
"""


@pytest.fixture(scope="module")
def rigs(tmp_path_factory):
    folder = tmp_path_factory.mktemp("characters")
    for who in CHARACTERS:
        write_character(who, folder / f"{who.name}.glb")
    return {who.name: Rig.load(folder / f"{who.name}.glb") for who in CHARACTERS}


@pytest.fixture(scope="module")
def files(trace, rigs, tmp_path_factory):
    """The run worn by each character, twice: two agents share its meshes."""
    folder = tmp_path_factory.mktemp("worn")
    twin = dataclasses.replace(trace.agents[0], name="bob")
    two = dataclasses.replace(trace, agents=(trace.agents[0], twin))
    for name, rig in rigs.items():
        write_gltf(two, folder / f"{name}.glb", rig)
    return {name: folder / f"{name}.glb" for name in rigs}


@pytest.mark.skipif(
    not validator_is_there(), reason="gltf-validator is not there: npm install gltf-validator"
)
@pytest.mark.parametrize("who", ["stout", "tall", "agent"])
def test_the_khronos_validator_finds_nothing(files, who):
    command = ["node", "-e", VALIDATE, str(files[who])]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True)
    report = json.loads(done.stdout)
    issues = report["issues"]
    assert (issues["numErrors"], issues["numWarnings"]) == (0, 0), issues["messages"]
    assert report["info"]["hasSkins"] and report["info"]["animationCount"] == 1


def moved(file, moment):
    """The file's nodes by name, with the animation at its frame ``moment``: where they are, Z up."""
    document = Document(file)
    nodes = document.json["nodes"]
    animation = document.json["animations"][0]
    for channel in animation["channels"]:
        output = animation["samplers"][channel["sampler"]]["output"]
        kind = "VEC3" if channel["target"]["path"] == "translation" else "VEC4"
        value = document.numbers(output, kind, "animations")[moment]
        nodes[channel["target"]["node"]][channel["target"]["path"]] = value.tolist()
    placed = node_places(document, nodes, node_order(document, nodes))
    return {node.get("name"): UPRIGHT @ placed[k, :3, 3] for k, node in enumerate(nodes)}


@pytest.mark.parametrize("who", ["stout", "tall", "agent"])
def test_bones_are_where_the_rig_says(trace, rigs, files, who):
    rig, agent = rigs[who], trace.agents[0]
    ground = Ground.from_arrays(trace.level.vertices, trace.level.faces)
    poses = rig.pose_motion(agent.poses, trace.times, agent.figure.bodies, ground)
    for moment in (0, len(trace.times) - 1):
        pose = poses[moment]
        places = moved(files[who], moment)
        for name in ("ada", "bob"):
            found = np.array([places[f"{name}/{bone}"] for bone in rig.names])
            np.testing.assert_allclose(found, pose[:, :3], atol=1e-4)
    assert not any("/pelvis" == name[-7:] and who != "agent" for name in places if name)


def test_meshes_are_there_once(files):
    document = Document(files["stout"]).json
    assert len(document["skins"]) == 2
    assert sum(mesh.get("name") == "stout" for mesh in document["meshes"]) == 1
    worn = [node for node in document["nodes"] if "skin" in node]
    assert len(worn) == 2 and worn[0]["mesh"] == worn[1]["mesh"]


@pytest.mark.skipif(shutil.which("node") is None, reason="no node here")
@pytest.mark.skipif(
    not (ROOT / "node_modules/three").exists(), reason="three.js is not there: npm install three"
)
def test_three_js_plays_it(trace, rigs, files):
    rig, agent = rigs["agent"], trace.agents[0]
    moment = len(trace.times) - 2
    seconds = float(trace.times[moment] - trace.times[0])
    command = ["node", "-e", PLAY, str(files["agent"]), str(seconds)]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True)
    found = json.loads(done.stdout)
    ground = Ground.from_arrays(trace.level.vertices, trace.level.faces)
    pose = rig.pose_motion(agent.poses, trace.times, agent.figure.bodies, ground)[moment]
    for bone in ("pelvis", "hand_l", "ball_r", "head"):
        np.testing.assert_allclose(UPRIGHT @ found[f"ada/{bone}"], pose[rig.names.index(bone), :3], atol=2e-3)
    assert "mesh" in found


def compressed(file, target, extension, packed):
    """A copy of a character with an ``extension`` that it requires; ``packed(document, data)`` changes it."""
    content = file.read_bytes()
    size = int.from_bytes(content[12:16], "little")
    document, data = json.loads(content[20 : 20 + size]), bytearray(content[28 + size :])
    document["extensionsUsed"] = document["extensionsRequired"] = [extension]
    packed(document, data)
    document["buffers"][0]["byteLength"] = len(data)
    target.write_bytes(glb(document, bytes(data)))
    return target


def test_a_character_compressed_with_meshopt_is_written_plain(trace, rigs, tmp_path):
    meshopt = pytest.importorskip("meshopt")

    def pack(document, data):
        for number in (0, document["skins"][0]["inverseBindMatrices"]):  # points and matrices
            view = document["bufferViews"][document["accessors"][number]["bufferView"]]
            begin, count = view["byteOffset"], document["accessors"][number]["count"]
            rows = np.frombuffer(data[begin : begin + view["byteLength"]], np.float32).reshape(count, -1)
            encoded = meshopt.encode_gltf_buffer(rows, "ATTRIBUTES")
            said = {"buffer": 0, "byteOffset": len(data), "byteLength": len(encoded), "count": count,
                    "byteStride": rows.strides[0], "mode": "ATTRIBUTES"}  # fmt: skip
            data.extend(encoded + bytes(-len(encoded) % 4))
            view["extensions"] = {"EXT_meshopt_compression": said}

    file = rigs["stout"].skeleton.path
    packed = compressed(Path(file), tmp_path / "packed.glb", "EXT_meshopt_compression", pack)
    rig = Rig.load(packed)
    np.testing.assert_array_equal(rig.rest, rigs["stout"].rest)
    np.testing.assert_array_equal(rig.skeleton.mesh.points, rigs["stout"].skeleton.mesh.points)
    write_gltf(trace, tmp_path / "run.glb", rig)
    assert "EXT_meshopt_compression" not in json.dumps(Document(tmp_path / "run.glb").json)


def test_a_character_compressed_with_draco_is_refused_by_name(trace, rigs, tmp_path, monkeypatch):
    def pack(document, data):
        for primitive in document["meshes"][0]["primitives"]:
            primitive["extensions"] = {"KHR_draco_mesh_compression": {"bufferView": 0, "attributes": {}}}

    rig = rigs["stout"]
    packed = compressed(Path(rig.skeleton.path), tmp_path / "packed.glb", "KHR_draco_mesh_compression", pack)
    worn = Rig(dataclasses.replace(rig.skeleton, path=str(packed)), bones_of_parts(rig.skeleton, None))
    with pytest.raises(
        RuntimeInputError, match="KHR_draco_mesh_compression; export the character without it"
    ):
        write_gltf(trace, tmp_path / "run.glb", worn)
    assert not (tmp_path / "run.glb").exists()


def test_a_run_without_people_is_refused(trace, rigs, tmp_path):
    rod = dataclasses.replace(trace.agents[0].figure, bodies=("rod",) * len(trace.agents[0].figure.bodies))
    nobody = dataclasses.replace(
        trace, agents=(dataclasses.replace(trace.agents[0], figure=rod, name="rex"),)
    )
    assert wears(trace.agents[0]) and not wears(nobody.agents[0])
    with pytest.raises(RuntimeInputError, match="in this run there are none, but rex"):
        write_gltf(nobody, tmp_path / "run.glb", rigs["stout"])


def test_a_world_tells_what_its_people_stand_on(graph, rigs):
    from runtime import World

    world = World(graph, seed=2)
    ada, rex = world.spawn("human", (2.0, 3.0, 0.0)), world.spawn("dog", (6.0, 3.0, 0.0))
    world.step(0.3)
    assert isinstance(ada.ground, Ground) and rex.ground is None
    pose = rigs["stout"].pose(ada)
    np.testing.assert_array_equal(
        pose, rigs["stout"].pose_from(ada.pose.transforms, ada.pose.names, ada.ground)
    )


def test_signs_of_quaternions_keep_neighbours_close():
    turns = np.array([[1.0, 0, 0, 0], [-1.0, 0, 0, 0], [1.0, 0, 0, 0]])
    np.testing.assert_array_equal(continuous(turns), np.tile([1.0, 0, 0, 0], (3, 1)))
