"""Which bone shows which part: mappings, VRM's table, names; and what is said if one is missing."""

import numpy as np
import pytest

from locomotion import LocomotionError, Rig
from locomotion.characters.bone_names import SHIPPED, bones_of_parts, load_bone_names
from locomotion.characters.character_file import read_character
from locomotion.characters.name_words import guessed_by_words
from locomotion.clips.retargeting import NEEDED_PARTS
from tests.locomotion.characters.test_character_file import changed


@pytest.mark.parametrize("name", SHIPPED)
def test_shipped_mappings_are_whole(name):
    assert set(load_bone_names(name)) >= set(NEEDED_PARTS)


@pytest.mark.parametrize("who, mapping", [("stout", "mixamo"), ("tall", "vrm"), ("agent", "unreal")])
def test_a_mapping_by_name_by_file_and_guessed_find_the_same(files, tmp_path, who, mapping):
    guessed = Rig.load(files[who]).parts
    assert guessed == Rig.load(files[who], mapping).parts
    lines = [f"{part}: {bone!r}" for part, bone in guessed.items()]
    (tmp_path / "own.yaml").write_text("\n".join(lines))
    assert Rig.load(files[who], tmp_path / "own.yaml").parts == guessed


@pytest.mark.parametrize("prefix", ["mixamorig", "mixamorig7:", "Character1_", "Armature|", "MIXAMORIG_"])
def test_prefixes_do_not_matter(files, tmp_path, prefix):
    def rename(document):
        for node in document["nodes"]:
            node["name"] = node["name"].replace("mixamorig:", prefix)

    rig = Rig.load(changed(files["stout"], tmp_path, rename), "mixamo")
    assert rig.parts["left_forearm"] == f"{prefix}LeftForeArm"
    assert rig.parts["chest"] == f"{prefix}Spine2"


@pytest.mark.parametrize(
    "scheme",
    [
        "Bip01 {S} {}", "{}.{S}", "DEF-{}_{S}", "{side}{}", "{}_{side}", "b_{s}_{}",
    ],
)  # fmt: skip
def test_words_in_names(files, scheme):
    """3ds Max, Blender, Daz and others, that no mapping of ours knows."""
    words = {"thigh": "Thigh", "shank": "Shin", "foot": "Foot", "toes": "Toe", "clavicle": "Shoulder",
             "upper_arm": "UpperArm", "forearm": "Forearm", "hand": "Hand"}  # fmt: skip
    skeleton = read_character(files["stout"])
    parts = bones_of_parts(skeleton, "mixamo")
    names = [f"Bone{k:03}" for k in range(len(skeleton.names))]
    for part, bone in parts.items():
        side, _, kind = part.partition("_")
        if kind in words:
            names[bone] = (
                scheme.replace("{S}", side[0].upper()).replace("{s}", side[0]).replace("{side}", side)
                .replace("{}", words[kind])
            )  # fmt: skip
    names[parts["pelvis"]], names[parts["head"]] = "Pelvis", "Head"
    found = guessed_by_words(names, skeleton.parents)
    assert {part: found.get(part) for part in parts} == parts


def test_missing_bones_are_listed_with_the_names_that_were_looked_for(files, tmp_path):
    def rename(document):
        for node in document["nodes"]:
            node["name"] = node["name"].replace("mixamorig:LeftForeArm", "Stick").replace("RightLeg", "Peg")

    file = changed(files["stout"], tmp_path, rename)
    for mapping in (None, "mixamo"):
        with pytest.raises(LocomotionError) as error:
            Rig.load(file, mapping)
        said = str(error.value)
        assert "right_shank (RightLeg)" in said and "left_forearm (LeftForeArm)" in said
        assert "mixamorig:Hips" in said and "\n" not in said and "left_thigh" not in said


def test_vrms_own_table_comes_before_all_names(files, tmp_path):
    skeleton = read_character(files["tall"])
    table = {"hips": "hips", "chest": "chest", "spine": "spine", "head": "head"}
    table |= {name: name for name in skeleton.names if name.startswith(("left", "right"))}

    def write(document, newer):
        numbers = {node["name"]: k for k, node in enumerate(document["nodes"])}
        for node in document["nodes"]:
            node["name"] = f"joint{numbers[node['name']]}"
        if newer:
            bones = {bone: {"node": numbers[name]} for bone, name in table.items()}
            document["extensions"] = {"VRMC_vrm": {"humanoid": {"humanBones": bones}}}
        else:
            bones = [{"bone": bone, "node": numbers[name]} for bone, name in table.items()]
            document["extensions"] = {"VRM": {"humanoid": {"humanBones": bones}}}

    plain = Rig.load(files["tall"])
    for newer in (True, False):
        rig = Rig.load(changed(files["tall"], tmp_path, lambda document, newer=newer: write(document, newer)))
        assert set(rig.parts) == set(plain.parts)
        np.testing.assert_array_equal(rig.rest, plain.rest)


@pytest.mark.parametrize(
    "text, said",
    [
        ("pelvis: Hips\n", "has no bone for chest"),
        ("pelvs: Hips\n", "did you mean 'pelvis'"),
        ("pelvis: []\n", "pelvis"),
        ("- a\n", "mapping"),
    ],
)
def test_mappings_with_mistakes(files, tmp_path, text, said):
    (tmp_path / "own.yaml").write_text(text)
    with pytest.raises(LocomotionError, match=said):
        Rig.load(files["stout"], tmp_path / "own.yaml")


def test_mappings_that_are_not_there(files, tmp_path):
    with pytest.raises(LocomotionError, match="did you mean 'mixamo'"):
        Rig.load(files["stout"], "mixamoo")
    with pytest.raises(LocomotionError, match="no such file"):
        Rig.load(files["stout"], tmp_path / "nowhere.yaml")


def test_bones_that_do_not_hang_together(files, tmp_path):
    parts = Rig.load(files["stout"]).parts
    parts["left_shank"], parts["right_shank"] = parts["right_shank"], parts["left_shank"]
    (tmp_path / "own.yaml").write_text("\n".join(f"{part}: {bone!r}" for part, bone in parts.items()))
    with pytest.raises(LocomotionError, match="does not hang on"):
        Rig.load(files["stout"], tmp_path / "own.yaml")
    parts["left_shank"] = parts["right_shank"]
    (tmp_path / "own.yaml").write_text("\n".join(f"{part}: {bone!r}" for part, bone in parts.items()))
    with pytest.raises(LocomotionError, match="at once"):
        Rig.load(files["stout"], tmp_path / "own.yaml")
