"""What is read of a character's file, and what is refused in one sentence."""

import json
import struct

import numpy as np
import pytest

from examples.make_characters import AGENT, STOUT, TALL, write_character
from locomotion import LocomotionError, Rig
from locomotion.characters.character_file import read_character


def changed(file, tmp_path, change):
    """A copy of a GLB file with ``change`` made to its JSON."""
    content = file.read_bytes()
    size = struct.unpack_from("<I", content, 12)[0]
    document = json.loads(content[20 : 20 + size])
    change(document)
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    rest = content[20 + size :]
    made = tmp_path / "changed.glb"
    made.write_bytes(
        b"glTF" + struct.pack("<II", 2, 20 + len(text) + len(rest)) + struct.pack("<I", len(text)) + b"JSON"
        + text + rest
    )  # fmt: skip
    return made


def node(document, name):
    return next(each for each in document["nodes"] if each["name"] == name)


def test_units_of_an_armature_count(files):
    """The tall one is in centimetres below a node of scale 0.01."""
    tall = read_character(files["tall"])
    hip = TALL.thigh + TALL.shank + TALL.ankle
    np.testing.assert_allclose(tall.places[tall.names.index("hips"), :3], [0, 0, hip + 0.03], atol=1e-6)
    np.testing.assert_allclose(tall.scales, 0.01)
    assert tall.mesh.points[:, 2].min() == pytest.approx(0.0, abs=1e-3)
    assert 1.9 < np.ptp(tall.mesh.points[:, 2]) < 2.2
    low = tall.names.index("leftFoot")
    assert tall.places[low, 0] == pytest.approx(TALL.hips)  # the file's left is +x, in the world, too


def test_a_scale_is_applied(files):
    rig, half = Rig.load(files["stout"]), Rig.load(files["stout"], scale=0.5)
    np.testing.assert_allclose(half.rest[:, :3], 0.5 * rig.rest[:, :3], atol=1e-12)


def test_bones_between_joints_belong_to_the_figure(files, tmp_path):
    def drop(document):
        joints = document["skins"][0]["joints"]
        at = joints.index(document["nodes"].index(node(document, "mixamorig:Spine1")))
        joints[at] = joints[0]

    found = read_character(changed(files["stout"], tmp_path, drop))
    assert "mixamorig:Spine1" in found.names


def test_points_follow_their_bones_at_rest(files):
    for name, who in (("stout", STOUT), ("agent", AGENT)):
        skeleton = read_character(files[name])
        assert (skeleton.parents < np.arange(len(skeleton.parents))).all()
        np.testing.assert_allclose(skeleton.mesh.shares.sum(axis=1), 1.0)
        assert np.ptp(skeleton.mesh.points[:, 2]) > who.thigh + who.shank + who.trunk


@pytest.mark.parametrize(
    "change, said",
    [
        (lambda d: d.pop("skins"), "refers to skins"),
        (lambda d: [each.pop("skin", 0) for each in d["nodes"]], "needs one that is bound to bones"),
        (lambda d: d["nodes"][3].update(scale=[1, 2, 1]), "scaled differently along its axes"),
        (lambda d: d["nodes"][3].update(scale=[-1, -1, -1]), "mirrored"),
        (lambda d: d["nodes"][3].update(scale=[0, 0, 0]), "its scale is 0"),
        (lambda d: d["skins"][0].update(joints=[0, 99999]), "refers to nodes"),
        (lambda d: d["nodes"][0].update(children=[0]), "is a child of"),
        (lambda d: d["asset"].update(version="1.0"), "glTF of version 1.0"),
        (lambda d: d.update(extensionsRequired=["NOT_KNOWN"]), "NOT_KNOWN"),
    ],
)
def test_what_cannot_be_read_is_refused_in_one_sentence(files, tmp_path, change, said):
    file = changed(files["stout"], tmp_path, change)
    with pytest.raises(LocomotionError, match=said) as error:
        Rig.load(file)
    assert str(file) in str(error.value) and "\n" not in str(error.value)


def test_cut_off_files(files, tmp_path):
    content = files["stout"].read_bytes()
    for size in (0, 11, 25, len(content) // 2, len(content) - 8):
        (tmp_path / "cut.glb").write_bytes(content[:size])
        with pytest.raises(LocomotionError, match="cannot be read as a character"):
            Rig.load(tmp_path / "cut.glb")
    with pytest.raises(LocomotionError, match="No such file"):
        Rig.load(tmp_path / "nowhere.glb")


@pytest.mark.parametrize("scale", [0.0, -1.0, "1", np.nan, True])
def test_a_scale_that_is_none(files, scale):
    with pytest.raises(LocomotionError, match="metres per unit"):
        Rig.load(files["stout"], scale=scale)


def test_the_same_figure_as_gltf_with_a_buffer_beside_it(files, tmp_path):
    content = files["stout"].read_bytes()
    size = struct.unpack_from("<I", content, 12)[0]
    document = json.loads(content[20 : 20 + size])
    document["buffers"][0]["uri"] = "data.bin"
    (tmp_path / "data.bin").write_bytes(content[28 + size :])
    (tmp_path / "hero.gltf").write_text(json.dumps(document))
    one, other = Rig.load(files["stout"]), Rig.load(tmp_path / "hero.gltf")
    np.testing.assert_array_equal(one.rest, other.rest)


def test_a_character_can_be_written_in_any_axes(tmp_path):
    write_character(AGENT, tmp_path / "a.glb")
    assert len(read_character(tmp_path / "a.glb").names) == 35
